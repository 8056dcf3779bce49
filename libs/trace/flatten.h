// The hierarchy of placements as a flat list of objects, transforms composed in double.
#pragma once
#include <deque>
#include <vector>

#include "trace/tracer.h"

namespace suite {

// A frame that moves, or that is there at times only: its axes -> the track's pose -> `before` -> the parent frame
// (kNone: ENU). What changes its material hangs on one node for each that it has.
struct MovingNode {
  uint32_t parent = kNone;  // a node with a smaller number
  Affine3 before;
  uint32_t track = kNone;     // index into Scene::tracks; kNone = at rest
  uint32_t schedule = kNone;  // index into Scene::schedules; kNone = always there
  uint32_t made = kNone;      // there while the schedule says so, and names this material (kNone: none)
};

struct Flattened {
  std::vector<TracedObject> objects;  // those always at rest first, then those on nodes
  std::vector<MovingNode> nodes;
  size_t fixed = 0;              // objects at rest
  std::deque<Affine3> composed;  // transforms that stand nowhere in the scene itself; objects point into it
};

// Depth-first in the order of the groups. The scene must outlive the result. Error when the hierarchy unfolds into more
// than `limit` objects.
Flattened flatten(const Scene& scene, size_t limit = size_t{1} << 28);

}  // namespace suite
