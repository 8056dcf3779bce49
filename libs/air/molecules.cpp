#include "air/molecules.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace suite {

double rayleigh_depth(double w, double pressure) {
  const double x = std::min(w, 1.0), w2 = x * x;
  const double depth =
      0.0021520 * (1.0455996 - 341.29061 / w2 - 0.90230850 * w2) / (1 + 0.0027059889 / w2 - 85.968563 * w2);
  return depth * std::pow(x / w, 4) * pressure / 101325;
}

Air standard_air(double height) {
  // Geopotential height, lapse rates and base temperatures (table 4 of the standard).
  constexpr double base[] = {0, 11000, 20000, 32000, 47000, 51000, 71000},
                   lapse[] = {-0.0065, 0, 0.001, 0.0028, 0, -0.0028, -0.002};
  constexpr double constant = 0.0341631947;  // g0 M / R, K/m
  const double h = std::max(0.0, height) * 6356766 / (6356766 + std::max(0.0, height));
  Air air;
  for (int i = 0; i < 7; ++i) {
    const double top = i < 6 ? std::min(h, base[i + 1]) : h, dh = top - base[i];
    if (dh <= 0) break;
    const double t = std::max(air.temperature + lapse[i] * dh, 150.0);
    air.pressure *= lapse[i] == 0 ? std::exp(-constant * dh / air.temperature)
                                  : std::pow(t / air.temperature, -constant / lapse[i]);
    air.temperature = t;
  }
  return air;
}

double rayleigh_phase(double cosine) {
  constexpr double depolarisation = 0.0279, gamma = depolarisation / (2 - depolarisation);
  return 3 / (16 * kPi * (1 + 2 * gamma)) * (1 + 3 * gamma + (1 - gamma) * cosine * cosine);
}

}  // namespace suite
