#include "mesh/weld.h"

#include <bit>

namespace suite {

std::vector<uint32_t> weld(std::span<const Vec3> positions) {
  constexpr uint32_t empty = 0xffffffffu;
  const size_t size = std::bit_ceil(2 * positions.size() + 2);
  std::vector<uint32_t> table(size, empty), first(positions.size());
  for (size_t i = 0; i < positions.size(); ++i) {
    const Vec3 p = positions[i] + Vec3{0, 0, 0};  // turns -0 into 0
    uint64_t h = 0x9e3779b97f4a7c15ull;
    for (int k = 0; k < 3; ++k) {
      h ^= std::bit_cast<uint64_t>(p[k]);
      h *= 0xff51afd7ed558ccdull;
      h ^= h >> 32;
    }
    size_t slot = h & (size - 1);
    while (table[slot] != empty && !(positions[table[slot]] == p)) slot = (slot + 1) & (size - 1);
    if (table[slot] == empty) table[slot] = static_cast<uint32_t>(i);
    first[i] = table[slot];
  }
  return first;
}

std::vector<uint32_t> welded_corners(std::span<const Vec3> positions, std::span<const uint32_t> indices) {
  const std::vector<uint32_t> first = weld(positions);
  std::vector<uint32_t> corners;
  corners.reserve(indices.size());
  for (const uint32_t v : indices) corners.push_back(first[v]);
  return corners;
}

}  // namespace suite
