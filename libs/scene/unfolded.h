// How much a hierarchy of groups unfolds into, counted without unfolding it.
#pragma once
#include <vector>

#include "scene/scene.h"

namespace suite {

// What can be unfolded: placements are numbered in 32 bits, and each takes some 100 bytes.
inline constexpr double kMostUnfolded = 268435456.0;  // 2^28

// Of each group: all placements, of groups too, on all levels below it. Children come after parents, as check_scene has
// it. Numbers of any size: doubles, at worst infinite.
std::vector<double> unfolded(const std::vector<Group>& groups);

}  // namespace suite
