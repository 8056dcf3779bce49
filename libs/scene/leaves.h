// The single things of a scene's hierarchy, by number: without walking through all of them, of which there may be 1e9.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace suite {

// One instance of a mesh or a primitive, as it is at a time.
struct Leaf {
  Affine3 place;  // local -> ENU
  TargetKind kind = TargetKind::mesh;
  uint32_t target = 0;                 // index into meshes or primitives
  uint32_t material_override = kNone;  // the outermost one on the way
  uint32_t tag = kNone;                // the innermost one
};

// Whether a tag stands on a placement of a group, so that several leaves are one thing.
bool tags_groups(const Scene& scene);

class Leaves {
 public:
  // scene must outlive it.
  explicit Leaves(const Scene& scene);
  uint64_t count() const { return of_.empty() ? 0 : of_[0]; }
  // number: below count(), that of truth images (the order of the hierarchy). Nothing when it is not there at time t,
  // s. Error: a track on the way does not cover t.
  std::optional<Leaf> at(uint64_t number, double t) const;
  // The first leaf of the thing that a leaf is part of: of the innermost placement on the way that has a tag; the leaf
  // itself where none has. number: below count().
  uint64_t object_of(uint64_t number) const;

 private:
  const Scene& scene_;
  std::vector<uint64_t> of_;                  // leaves of each group
  std::vector<std::vector<uint64_t>> first_;  // of each group: leaves before each placement
};

}  // namespace suite
