// Far points of a light, stars: too small for any path to meet, so that sensors that can put them on their focal plane
// themselves (sensor/point_images.h).
#pragma once
#include <vector>

#include "math/vec.h"
#include "spectral/state.h"

namespace suite {

struct FarPoint {
  int number = 0;  // in its catalogue
  double v = 0;    // magnitude
  double kelvin = 0;
  Dir direction;  // towards it at the moment of FarPoints, scene ENU, lifted by the air of the place
};

struct FarPoints {
  std::vector<FarPoint> points;
  Dir pole;            // they turn about it with the Earth, scene ENU
  double seconds = 0;  // simulation time of the directions
  double scale = 1;    // of all their light

  // Towards a point at a time (s). Refraction is that of the moment.
  Dir direction_at(const FarPoint& point, double time) const;
  // Above the air, W/(m2 um), the mean of each bin.
  std::vector<double> irradiance(const FarPoint& point, const SpectralState& state) const;
};

}  // namespace suite
