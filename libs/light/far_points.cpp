#include "light/far_points.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "light/kinds/clear_sky.h"
#include "light/kinds/solar_spectrum.h"
#include "light/night/glow.h"
#include "light/night/scintillation.h"
#include "light/night/stars.h"
#include "math/sampling.h"
#include "spectral/planck.h"

namespace suite {

Dir FarPoints::direction_at(const FarPoint& point, const PointLook& look) const {
  if (point.moving) return normalized(point.moving->at(look.time) - look.from);
  constexpr double kEarthRate = 7.292115e-5;  // rad/s
  const double angle = -kEarthRate * (look.time - seconds), c = std::cos(angle), s = std::sin(angle);
  const Dir d = point.direction;
  const Dir bare = normalized(d * c + cross(pole, d) * s + pole * (dot(pole, d) * (1 - c)));
  return air ? air->seen(bare, look.from) : bare;
}

double FarPoints::scintillation_of(size_t point, const Watched& how) const {
  if (!scintillation || !points[point].twinkles || !(how.aperture > 0)) return 1;
  const double index = scintillation_index(how.aperture, air_mass(polar_angle(how.direction)),
                                           std::max(0.0, height + how.from.z), how.end - how.begin);
  return suite::scintillation(index, hash_of(*scintillation, point, std::bit_cast<uint64_t>(how.begin)));
}

std::vector<double> FarPoints::irradiance(const FarPoint& point, const SpectralState& state,
                                          const PointLook& look) const {
  std::vector<double> e;
  if (point.moving) {
    const double share = point.scale * point.moving->share(look.time, look.from);
    for (const Bin& bin : state.bins) {
      const double low = std::max(bin.low_um, kNightLow), high = std::min(bin.high_um, kNightHigh);
      e.push_back(high > low ? share * solar_irradiance().mean(low, high) * (high - low) / (bin.high_um - bin.low_um)
                             : 0);
    }
    return e;
  }
  const double at_v = point.scale * kVegaIrradiance * flux_of(point.v);
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
