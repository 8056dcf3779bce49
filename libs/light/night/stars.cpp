#include "light/night/stars.h"

#include <algorithm>
#include <cmath>

#include "light/night/glow.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr int kStars[] = {
#include "light/night/stars.inc"
};
constexpr size_t kFields = 7, kCount = 9096;
static_assert(std::size(kStars) == kFields * kCount);

}  // namespace

const std::vector<CatalogueStar>& bright_star_catalogue() {
  static const std::vector<CatalogueStar> all = [] {
    std::vector<CatalogueStar> stars;
    stars.reserve(kCount);
    constexpr double kPlace = 1e-5 * kDegree, kMotion = 1e-3 / 3600 * kDegree;
    for (const int* s = kStars; s != std::end(kStars); s += kFields)
      stars.push_back({std::to_string(s[0]),
                       {s[1] * kPlace, s[2] * kPlace, s[5] * kMotion / std::cos(s[2] * kPlace), s[6] * kMotion},
                       0.01 * s[3],
                       star_temperature(0.01 * s[4])});
    return stars;
  }();
  return all;
}

double flux_of(double v) { return std::pow(10, -0.4 * v); }

double star_temperature(double colour) {
  const double c = std::clamp(colour, -0.4, 6.0);
  return 4600 * (1 / (0.92 * c + 1.7) + 1 / (0.92 * c + 0.62));
}

Curve star_shape(double kelvin) {
  // Chords over 1 % of wavelength follow a blackbody to 1e-4.
  std::vector<double> x, y;
  for (double w = kNightLow; w < kNightHigh; w *= 1.01) x.push_back(w);
  x.push_back(kNightHigh);
  const double at_v = planck_radiance(0.55, kelvin);
  for (const double w : x) y.push_back(planck_radiance(w, kelvin) / at_v);
  return Curve(std::move(x), std::move(y), Outside::zero);
}

double s10_radiance() { return kVegaIrradiance * 1e-4 / (kDegree * kDegree); }

double starlight_s10(double sine) { return 47.2 / (std::fabs(sine) + 0.12); }

Dir galactic_pole() { return dir_from_angles((90 - 27.12825) * kDegree, 192.85948 * kDegree); }

}  // namespace suite
