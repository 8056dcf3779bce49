// Bodies of media: which surfaces bound them, what a crossing changes, and where a path starts. What their sides fill
// is stated in medium_stack.h.
//
// Bodies may touch: rays leave a surface a little off it, and all that lies on that little way is crossed with it.
#pragma once
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "scene/bounded_side.h"
#include "surface/surface.h"
#include "transport/media/medium_stack.h"

namespace suite {

class Bodies {
 public:
  explicit Bodies(const Surface& surface);

  bool any() const { return any_; }
  // A surface that rays pass without being scattered: it only bounds a medium.
  bool is_boundary(uint32_t material) const { return material != kNone && rules_[material].boundary; }
  bool any_boundary() const { return any_boundary_; }
  // A ray goes through the surface at `hit` in `direction`. The Earth under the scene bounds no medium.
  void cross(MediumStack& stack, const Hit& hit, uint32_t material, Dir direction) const;
  // The same for one that is no boundary, with the boundaries that lie on it.
  void transmit(MediumStack& stack, const Hit& hit, uint32_t material, Dir direction, TraceStatistics& statistics);
  // How a ray goes on behind a boundary.
  struct Onward {
    Vec3 start;  // of the next ray to be traced
    double gap;  // m along the ray from the boundary to there
  };
  // Puts a hit of `ray` on the ray, of which rounding moves it along its surface, and adds `gap` to its distance:
  // errors of hundreds of boundaries then do not add up.
  void settle(Hit& hit, const Ray& ray, double gap) const;
  // Takes a ray through the boundary at `hit`, `run` m behind its start, and through all others that lie where the next
  // ray cannot see them. Nothing when a surface that is no boundary lies there: it is put into hit.
  std::optional<Onward> pass(MediumStack& stack, Hit& hit, const Ray& ray, double run, TraceStatistics& statistics);
  // The bodies around a place, found by counting crossings on a ray upwards, and on one downwards for half-spaces
  // that go on upwards; remembers the last place asked for.
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
  enum class Fills : uint8_t { bounded_side, half_spaces, shared_face };
  struct Sides {
    Fills fills = Fills::bounded_side;
    bool bounded = true;  // of a closed surface: the side that is filled, true = behind
  };
  bool bounds(uint32_t material) const {
    return material != kNone && (rules_[material].medium[0] != kNone || rules_[material].medium[1] != kNone);
  }
  // Copies of one object that a periodic scene puts at its sides are one body.
  uint32_t body(const Hit& hit) const { return surface_.tracer().object(hit.object).instance; }
  int priority(uint32_t medium) const {  // clear matter: 0
    const std::vector<Medium>& named = surface_.tracer().scene().media;
    return medium < named.size() ? named[medium].priority : 0;
  }
  Sides sides(const Hit& hit) const;
  bool cross(MediumStack& stack, const Hit& hit, const Rule& rule, bool behind) const;
  void probe(Vec3 place, Dir direction, double time, TraceStatistics& statistics);
  static Onward onward(const Hit& hit, Dir direction, double step);
  Onward look_beside(const Hit& hit, const Ray& ray, double run, TraceStatistics& statistics);
  void find_beside(const Hit& hit, const Ray& from, double back, double length, TraceStatistics& statistics);
  std::optional<size_t> stop() const;
  bool crosses(size_t i, Dir direction) const;

  const Surface& surface_;
  std::vector<Rule> rules_;                                      // per material
  std::unordered_set<uint32_t> unbounded_;                       // bodies
  mutable std::unordered_map<uint32_t, BoundedSide> of_meshes_;  // those that were asked for
  bool any_ = false, any_boundary_ = false, asked_ = false;
  bool below_ = false;  // some half-space may be found by a ray downwards alone
  bool alone_ = false;  // nothing can touch the only object
  Vec3 place_;
  double time_ = 0;
  MediumStack around_, entered_;
  // What lies at the boundary that is being crossed, nearest first, that boundary included, and the materials.
  std::vector<Hit> beside_;
  double back_ = 0;  // m along the ray from where that begins to the boundary
  std::vector<uint32_t> materials_;
  struct Left {
    uint32_t body, medium;
    bool side, half_space, shared;
  };
  std::vector<Left> left_;
};

}  // namespace suite
