// A share of each pixel's light, moved to a disk about it.
#pragma once
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace suite {

// (1 - share) * light + share * (light spread evenly over a disk). light: row-major; radius: pixels right and down.
// What falls outside the picture is lost; nothing comes in from there.
std::vector<double> over_disk(const std::vector<double>& light, uint32_t columns, Vec2 radius, double share);

}  // namespace suite
