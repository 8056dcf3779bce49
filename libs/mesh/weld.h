// Equal positions get equal numbers.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

// For every position the index of the first one that equals it bit for bit (-0 equals 0).
std::vector<uint32_t> weld(std::span<const Vec3> positions);

// The corners of a mesh by these numbers.
std::vector<uint32_t> welded_corners(std::span<const Vec3> positions, std::span<const uint32_t> indices);

}  // namespace suite
