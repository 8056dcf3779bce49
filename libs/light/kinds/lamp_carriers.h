// Placements of the scene that carry lamps: where they are and how they are turned at a time, and whether they are
// there then. A name means every placement that has it as its tag, and every one that places the object or the group of
// that name, in all the groups in which it stands. Internal to lamps.
//
// Assumes: what carries a lamp is neither mirrored nor stretched; it may be made larger or smaller by itself, but not
// by the groups around it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "motion/track.h"
#include "scene/scene.h"

namespace suite {

class LampCarriers {
 public:
  // Keeps a reference.
  explicit LampCarriers(const Scene& scene) : scene_(scene) {}
  // Those of a name, by number. Error at `where`: there is none, there are more than 2^20, or one is mirrored,
  // stretched or in a group that is scaled.
  std::vector<uint32_t> find(const std::string& name, const Where& where);
  // Whether it moves, comes or goes.
  bool changes(uint32_t carrier) const { return !carriers_[carrier].steps.empty(); }
  // By which its own transform scales what it places.
  double scale(uint32_t carrier) const { return carriers_[carrier].scale; }
  // From the axes of what it places, scaled, to ENU. Nothing while it is not there.
  std::optional<Pose> at(uint32_t carrier, double time) const;

  // Everywhere that a point of it is in a span of time, and where a direction leads.
  struct Sweep {
    Box3 box;         // m, ENU
    Dir axis;         // ENU, in the middle
    double turn = 0;  // rad, by which it is elsewhere at most
  };
  // Nothing when it is never there. From its places at the ends, at kinks and at some times between; the box is
  // widened, and the turn enlarged, by what lies between two of them.
  std::optional<Sweep> over(uint32_t carrier, Vec3 point, Dir axis, TimeSpan span) const;

 private:
  struct Step {
    Pose before;
    uint32_t track, schedule;
  };
  struct Carrier {
    std::vector<Step> steps;  // from the root on
    Pose last;
    double scale = 1;
  };
  void walk(uint32_t group, const Carrier& above, const std::string& name, const Where& where,
            std::vector<uint32_t>& found);
  bool has_name(const Placement& p, const std::string& name) const;

  const Scene& scene_;
  std::vector<Carrier> carriers_;
};

}  // namespace suite
