// How fast a prepared scene loads, against a plain read of the same bytes in the same run (warm file cache).
// Usage: scene_load_bench scene.h5
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>

#include <fcntl.h>
#include <unistd.h>

#include "base/error.h"
#include "base/files.h"
#include "formats/scene_hdf/scene_hdf.h"

namespace {
double seconds(const std::function<void()>& work) {
  double best = 1e300;
  for (int k = 0; k < 7; ++k) {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}
}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: scene_load_bench scene.h5\n"), 2;
  const size_t size = suite::file_size(argv[1]);
  const double plain = seconds([&] {
    const std::unique_ptr<char[]> memory(new char[size]);
    const int fd = ::open(argv[1], O_RDONLY);
    size_t got = 0;
    while (got < size) {
      const ssize_t n = ::read(fd, memory.get() + got, size - got);
      if (n <= 0) break;
      got += static_cast<size_t>(n);
    }
    ::close(fd);
  });
  size_t triangles = 0;
  const double load = seconds([&] {
    const suite::Scene scene = suite::read_scene(argv[1]);
    triangles = 0;
    for (const suite::Mesh& m : scene.meshes) triangles += m.triangle_count();
  });
  std::printf(
      "%zu bytes, %zu triangles: plain read %.4f s (%.2f GB/s), load and check %.4f s (%.2f GB/s), ratio %.2f\n", size,
      triangles, plain, static_cast<double>(size) / plain / 1e9, load, static_cast<double>(size) / load / 1e9,
      load / plain);
  return 0;
} catch (const suite::Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
