#include "trace/loose_mesh.h"

#include <algorithm>
#include <bit>

#include "math/sampling.h"

namespace suite {

bool is_loose(const Mesh& mesh) {
  const auto place = [&](uint32_t vertex) {
    const float* p = &mesh.positions[3 * size_t{vertex}];
    const auto bits = [](float x) { return uint64_t{std::bit_cast<uint32_t>(x + 0.0f)}; };  // of both zeros the same
    return hash_of(bits(p[0]) << 32 | bits(p[1]), bits(p[2]));
  };
  // Which edges are looked at is a matter of their places: those that are shared are found all times or never.
  constexpr size_t kEnough = 1u << 14;
  const uint64_t mask = std::bit_ceil(std::max<size_t>(1, 3 * mesh.triangle_count() / kEnough)) - 1;
  std::vector<uint64_t> edges;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    uint64_t corner[3];
    for (size_t c = 0; c < 3; ++c) corner[c] = place(mesh.indices[3 * t + c]);
    for (size_t c = 0; c < 3; ++c)
      if (const uint64_t edge = mix64(corner[c] + corner[(c + 1) % 3]); (edge & mask) == 0) edges.push_back(edge);
  }
  std::sort(edges.begin(), edges.end());
  size_t shared = 0, alone = 0;
  for (size_t i = 0, next; i < edges.size(); i = next) {
    for (next = i + 1; next < edges.size() && edges[next] == edges[i];) ++next;
    ++(next - i > 1 ? shared : alone);
  }
  return shared <= alone;
}

}  // namespace suite
