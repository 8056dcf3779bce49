// Memory of a prepared scene in the renderer: what loading takes, what the acceleration structures take, and the peak,
// in bytes per stored triangle. Usage: memory_bench scene.h5
#include <malloc.h>

#include <cstdio>
#include <string>

#include "base/error.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "tests/bench/memory.h"
#include "trace/tracer.h"

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: memory_bench scene.h5\n"), 2;
  const auto scene = std::make_shared<const suite::Scene>(suite::read_scene(argv[1]));
  double triangles = 0;
  for (const suite::Mesh& m : scene->meshes) triangles += static_cast<double>(m.triangle_count());
  malloc_trim(0);
  const double loaded = suite::bench::memory("VmRSS:"), loading = suite::bench::memory("VmHWM:");
  const suite::Tracer tracer(scene);
  // Rays from above, so that tiles that wait for one are built too.
  const suite::Vec3 low = tracer.bounds().low, size = tracer.bounds().size();
  size_t hits = 0;
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < 200; ++j) {
      const suite::FlushDenormals flush;
      const suite::Ray ray{
          low + suite::Vec3{(i + 0.5) / 200 * size.x, (j + 0.5) / 200 * size.y, 2 * size.z + 10}, {0, 0, -1}, 0};
      suite::Hit hit;
      suite::TraceStatistics statistics;
      tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
      hits += hit.hit() ? 1 : 0;
    }
  const double built = suite::bench::memory("VmRSS:"), peak = suite::bench::memory("VmHWM:");
  std::printf("%.0f triangles stored, %zu unfolded, %zu of %zu tiles built, %zu of 40000 rays hit\n", triangles,
              tracer.triangles(), tracer.tiles_built(), tracer.tiles(), hits);
  std::printf("bytes a triangle, the whole program: loaded %.1f (peak %.1f), built %.1f (peak %.1f)\n",
              loaded / triangles, loading / triangles, built / triangles, peak / triangles);
  return 0;
} catch (const suite::Error& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
