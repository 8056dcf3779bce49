// One point's sunlight at one moment, found anew: what the audit of temperatures holds against that of the elements.
#pragma once
#include <span>

#include "heat/heat_balance.h"
#include "heat/heat_walk.h"

namespace suite {

// Uniform numbers of a walk.
using WalkNumbers = Pcg32;

class AuditSun {
 public:
  // Keeps references.
  AuditSun(const Tracer& tracer, const HeatOptics& optics, const WeatherLoads& weather, double ground_albedo);

  // W/m2 that the surface at a hit absorbs of beam, sky and ground at a time (s, within the weather's moments): one
  // draw, whose mean is right. side: 1 of the front, -1 of the back. Without beams that mirrors send on
  // (sunlight_mirrored.h), which paths from here cannot find.
  double absorbed(const Hit& hit, double side, double t, WalkNumbers& numbers);
  double rays() const { return static_cast<double>(trace_.rays); }

 private:
  struct Light {  // at a moment, W/m2 and W/(m2 sr)
    double direct = 0, global = 0;
    size_t moment = 0;  // the nearest
    Frame sun;
  };
  Light light_at(double t) const;
  double straight(const Hit& hit, double side, double t, const Light& light, Vec2 disk);
  double scattered(const Hit& hit, double side, double t, const Light& light, WalkNumbers& numbers);
  double outside(Dir d, const Light& light) const;
  bool sees_sun(const Hit& hit, Dir d, double t, uint32_t draw);
  double asked(const Hit& hit, Dir out, double t, const Light& light, WalkNumbers& numbers);

  const Tracer& tracer_;
  const WeatherLoads& weather_;
  double ground_albedo_;
  Surface surface_;
  Interaction at_;
  std::vector<float> W_, w_, T_;
  size_t knots_;
  SurfaceWalk walk_;
  TraceStatistics trace_;
};

}  // namespace suite
