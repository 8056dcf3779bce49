// The hierarchy of placements as flat lists of objects, transforms composed in double: one list for the scene, and one
// for the inside of each group that is shared (scene/unfolded.h), however often it is placed.
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

// What hangs in one frame. Objects name a mesh or an exact surface, or stand for a placement of a shared group; their
// materials, tags and instance numbers are those within the frame.
struct Assembly {
  std::vector<PlacedObject> objects;
  std::vector<uint32_t> shared;  // of each object: the shared group that it places, kNone = none; empty = none does
  std::deque<Affine3> composed;  // transforms that stand nowhere in the scene itself; objects point into it
  uint32_t shared_of(size_t object) const { return shared.empty() ? kNone : shared[object]; }
};

// The inside of a group that is kept once. The scene's transforms are composed from the outside in, and so are these:
// the last bits are those of the unfolded scene.
struct SharedGroup : Assembly {
  struct Via {  // a group that was unfolded in this one
    uint32_t above;
    const Affine3* to_parent;
  };
  struct Last {  // the group that places an object (kNone: this one), and where in it
    uint32_t via;
    const Affine3* own;
  };
  std::vector<Via> vias;
  std::vector<Last> last;  // of each object; empty = no group was unfolded
  uint32_t instances = 0;  // numbers that a placement of it takes
  Affine3 placed(const Affine3& group, size_t object) const;

 private:
  Affine3 placed_via(const Affine3& group, uint32_t via) const;
};

// An object on the way down to it, or at its end.
struct Way {
  TracedObject object;
  uint32_t number = 0;  // of the object; of a shared group: of its first one
  Affine3 place;        // as PlacedObject's, of the object itself
};

struct Flattened : Assembly {  // objects: those always at rest first, then those on nodes
  std::vector<MovingNode> nodes;
  size_t fixed = 0;                 // objects at rest
  std::vector<SharedGroup> groups;  // those that hold others come before these
  std::vector<uint32_t> first;      // of each object: its number, or that of the first one inside; empty = its index

  // Numbers the objects again after some were added. Error when there are too many.
  void number_objects();
  uint32_t number(uint32_t object) const { return first.empty() ? object : first[object]; }
  uint32_t numbers() const { return numbers_; }  // all are smaller; some of a shared group's may stand for nothing
  uint32_t with_number(uint32_t number) const;   // index of the object that has it, or holds it
  Way way(uint32_t object) const { return {objects[object], this->number(object), *objects[object].place}; }
  // One step down into a shared group.
  void step(Way& way, const SharedGroup& group, uint32_t object) const;
  // All the way to an object of a number; nothing when the number stands for nothing.
  std::optional<Way> way_to(uint32_t number) const;
  // The same of a number that stands for something. Whoever looks at a hit asks several times: the thread keeps the
  // last one. Valid until the thread's next call.
  const Way& way_again(uint32_t number) const;

 private:
  uint32_t numbers_ = 0;
  uint64_t edition_ = 0;
};

// Depth-first in the order of the groups. The scene must outlive the result. keep: as share_groups has it. Error when
// the hierarchy unfolds into more instances, or keeps more objects, than can be.
Flattened flatten(const Scene& scene, double keep);

}  // namespace suite
