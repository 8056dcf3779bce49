// Far points of a light, stars and planets: too small for any path to meet, so that sensors that can put them on their
// focal plane themselves (sensor/point_images.h).
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "math/vec.h"
#include "spectral/curve.h"
#include "spectral/state.h"

namespace suite {

struct FarPoint {
  std::string name;  // in its catalogue
  double v = 0;      // magnitude
  double scale = 1;  // of its light
  double kelvin = 0;
  std::shared_ptr<const Curve> shape = {};  // over that at 0.55 um; null = a blackbody's of `kelvin`
  Dir direction;  // towards it at the moment of FarPoints, scene ENU, lifted by the air of the place
};

struct FarPoints {
  std::vector<FarPoint> points;
  Dir pole;            // they turn about it with the Earth, scene ENU
  double seconds = 0;  // simulation time of the directions

  // Towards a point at a time (s). Refraction is that of the moment.
  Dir direction_at(const FarPoint& point, double time) const;
  // Above the air, W/(m2 um), the mean of each bin.
  std::vector<double> irradiance(const FarPoint& point, const SpectralState& state) const;
};

}  // namespace suite
