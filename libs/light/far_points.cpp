#include "light/far_points.h"

#include <algorithm>
#include <cmath>

#include "light/night/glow.h"
#include "light/night/stars.h"
#include "spectral/planck.h"

namespace suite {

Dir FarPoints::direction_at(const FarPoint& point, double time) const {
  constexpr double kEarthRate = 7.292115e-5;  // rad/s
  const double angle = -kEarthRate * (time - seconds), c = std::cos(angle), s = std::sin(angle);
  const Dir d = point.direction;
  return normalized(d * c + cross(pole, d) * s + pole * (dot(pole, d) * (1 - c)));
}

std::vector<double> FarPoints::irradiance(const FarPoint& point, const SpectralState& state) const {
  const double at_v = point.scale * kVegaIrradiance * flux_of(point.v);
  std::vector<double> e;
  if (point.shape) {
    for (const Bin& bin : state.bins) e.push_back(at_v * point.shape->mean(bin.low_um, bin.high_um));
    return e;
  }
  const double of_planck = at_v / planck_radiance(0.55, point.kelvin);
  for (const Bin& bin : state.bins) {
    const double low = std::max(bin.low_um, kNightLow), high = std::min(bin.high_um, kNightHigh);
    e.push_back(high > low ? of_planck * planck_band_radiance(low, high, point.kelvin) / (bin.high_um - bin.low_um)
                           : 0);
  }
  return e;
}

}  // namespace suite
