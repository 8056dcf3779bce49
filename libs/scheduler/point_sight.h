// What arrives of a far point along a line of sight: hidden by what stands in it, weakened by air, by flat smooth
// surfaces that it passes, and by one that mirrors it (transport/flat_mirrors.h).
#pragma once
#include "scheduler/primed.h"

namespace suite {

class PointSight {
 public:
  // Keeps a reference. Without flat mirrors whatever stands in the way hides a point.
  explicit PointSight(const Primed& primed);

  // Normals of the mirrors that points may be seen in.
  std::span<const Dir> mirrors() const;
  // Light that comes from direction `to` above the air, as share of each bin, where one looks along d from a place
  // (m, ENU) at a time (s), by way of one mirror or of none. All 0: hidden. Valid until the next call.
  struct Sightline {
    double time = 0;
    Vec3 origin;
    Dir direction, to;
    bool mirrored = false;
  };
  std::span<const double> look(const Sightline& sight);

 private:
  // A ray that has come so far.
  struct Line {
    Vec3 origin;
    Dir direction;
    int faces = 0;
    bool mirrored = false, within = false;  // matter behind the front of a surface
    std::vector<float> weight;              // of each bin
  };
  bool leaves(const Line& line) const;  // nothing but the Earth is asked for
  void follow(const Line& line, int knot);
  void split(const Line& line, const Hit& hit, int knot);
  void through_air(const Line& line, double distance, std::vector<float>& weight);

  const Primed& primed_;
  Sightline sight_;
  const std::vector<int> knot_of_bin_;
  std::vector<double> arrived_;
  std::vector<float> air_;
};

}  // namespace suite
