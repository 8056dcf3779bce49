// Satellites in sunlight, too small to be resolved: points that move over the sky and go out in the Earth's shadow.
//
// Assumes: matte spheres without features (flashes of panels are left out); a shadow that is a cylinder of the Earth's
// radius, without penumbra and refracted light (a satellite at 400 km crosses the difference in some 10 s). Based on:
// W. D. Heacox, "Phase functions of Lambert spheres" in the form of E. Whitmell, Observatory 30, 1907:
// E = E_sun a A / d^2 times 2 (sin p + (pi - p) cos p) / (3 pi^2) at a phase angle p.
#pragma once
#include <memory>
#include <string>

#include "motion/track.h"

namespace suite {

struct SatelliteSpec {
  std::string name;
  std::shared_ptr<const Sgp4> orbit;
  double area = 10;     // m2, of the cross-section
  double albedo = 0.2;  // Bond
};

// At the Sun's place of a moment.
class SunlitPoint {
 public:
  // to_sun: unit, scene ENU.
  SunlitPoint(TrackPtr track, const SceneFrame& frame, Dir to_sun, double reflecting_m2);
  Vec3 at(double time) const { return track_->at(time).point({0, 0, 0}); }  // m, scene ENU
  // Irradiance at a place facing it, over that of the Sun at 1 AU; 0 in the Earth's shadow.
  double share(double time, Vec3 from) const;

 private:
  TrackPtr track_;
  Vec3 centre_;  // of the Earth
  Dir to_sun_;
  double reflecting_;
};

}  // namespace suite
