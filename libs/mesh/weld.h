// Equal positions get equal numbers.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

// For every position the index of the first one that equals it bit for bit (-0 equals 0).
std::vector<uint32_t> weld(std::span<const Vec3> positions);

}  // namespace suite
