#include "light/night/city_glow.h"

#include <algorithm>
#include <cmath>

namespace suite {

double relative_glow(const CityGlow& glow, Dir d) {
  if (d.z < 0) return 0;
  const double turn = std::remainder(std::atan2(d.y, d.x) - glow.azimuth, 2 * kPi) / glow.width;
  return std::exp(-std::asin(std::min(1.0, d.z)) / glow.height - 0.5 * turn * turn);
}

double walker_luminance(double people, double distance_km) {
  constexpr double kNatural = 10.8e4 * 1.5848931924611e-9;  // cd/m2 of V = 22: 10.8e4 x 10^(-0.4 V)
  return 0.01 * people * std::pow(distance_km, -2.5) * kNatural;
}

}  // namespace suite
