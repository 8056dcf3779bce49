// How much a hierarchy of groups unfolds into, and which groups are better kept once for all their placements; both
// without unfolding it.
#pragma once
#include <vector>

#include "scene/scene.h"

namespace suite {

// Instances are numbered in 32 bits.
inline constexpr double kMostInstances = 4294967294.0;  // 2^32 - 2
// What can be kept: each placement takes some 250 bytes.
inline constexpr double kMostKept = 268435456.0;  // 2^28
// Scenes of no more instances are unfolded altogether, which is fastest.
inline constexpr double kUnfoldedAtMost = 2097152.0;  // 2^21

// Numbers of any size: doubles, at worst infinite.
struct Sharing {
  std::vector<double> instances;  // of each group: meshes and exact surfaces on all levels below it, copies counted
  std::vector<char> shared;       // of each group: kept once, and its placements as things of their own
  double kept = 0;                // placements that are kept in all
};

// Shares no group while the scene's instances are at most `most`; beyond that those that save most, one by one, until
// no more than that is kept or nothing is saved. A group with something below it that moves, comes or goes, or that has
// no bounds, is never shared. Children come after parents, as check_scene has it.
Sharing share_groups(const Scene& scene, double most = kUnfoldedAtMost);

}  // namespace suite
