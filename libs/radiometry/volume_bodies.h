// Bodies of media: which surfaces bound them, what a crossing changes, and where a path starts.
#pragma once
#include <vector>

#include "radiometry/medium_stack.h"
#include "surface/surface.h"

namespace suite {

class Bodies {
 public:
  explicit Bodies(const Surface& surface);

  bool any() const { return any_; }
  // A surface that rays pass without being scattered: it only bounds a medium.
  bool is_boundary(uint32_t material) const { return material != kNone && rules_[material].boundary; }
  bool any_boundary() const { return any_boundary_; }
  // A ray goes through the surface at `hit` in `direction`.
  void cross(MediumStack& stack, const Hit& hit, uint32_t material, Dir direction) const;
  // The bodies around a place, found by counting crossings on a ray upwards; remembers the last place asked for.
  // Assumes: bodies are closed, or unbounded as a sea surface.
  const MediumStack& around(Vec3 place, double time, TraceStatistics& statistics);
  // After a ray has left the scene without meeting anything: only unbounded bodies can still be around it. (Rays that
  // slip through an edge of a mesh come right again here.)
  void leave_scene(MediumStack& stack) const;

 private:
  struct Rule {
    uint32_t medium[2] = {kNone, kNone};  // in front, behind
    bool boundary = false;
  };
  // Copies of one object that a periodic scene puts at its sides are one body.
  uint32_t body(const Hit& hit) const { return surface_.tracer().objects()[hit.object].instance; }
  int priority(uint32_t medium) const { return medium == kNone ? 0 : surface_.tracer().scene().media[medium].priority; }
  const Surface& surface_;
  std::vector<Rule> rules_;      // per material
  std::vector<bool> unbounded_;  // per body
  bool any_ = false, any_boundary_ = false, asked_ = false;
  Vec3 place_;
  double time_ = 0;
  MediumStack around_;
};

}  // namespace suite
