#include "light/night/zodiacal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "light/kinds/solar_spectrum.h"
#include "math/vec.h"

namespace suite {

namespace {

constexpr double kLongitude[] = {0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 60, 75, 90, 105, 120, 135, 150, 165, 180},
                 kLatitude[] = {0, 5, 10, 15, 20, 25, 30, 45, 60, 75, 90};
constexpr double kTable[] = {
#include "light/night/zodiacal.inc"
};
constexpr size_t kZodiacalRows = std::size(kLongitude), kZodiacalColumns = std::size(kLatitude);
static_assert(std::size(kTable) == kZodiacalRows * kZodiacalColumns);
constexpr double kPower = 2.1, kNearest = 2.5;  // degrees from the Sun, within which it is even

double elongation_deg(double longitude_deg, double latitude_deg) {
  return std::acos(std::cos(longitude_deg * kDegree) * std::cos(latitude_deg * kDegree)) / kDegree;
}

// Logarithms, with what is not given from the first value of the same latitude that is.
std::array<double, kZodiacalRows * kZodiacalColumns> logarithms() {
  std::array<double, kZodiacalRows * kZodiacalColumns> logs{};
  for (size_t c = 0; c < kZodiacalColumns; ++c) {
    size_t first = 0;
    while (kTable[first * kZodiacalColumns + c] == 0) ++first;
    const double from = elongation_deg(kLongitude[first], kLatitude[c]);
    for (size_t r = 0; r < kZodiacalRows; ++r) {
      const double given = kTable[std::max(r, first) * kZodiacalColumns + c],
                   e = std::max(kNearest, elongation_deg(kLongitude[r], kLatitude[c]));
      logs[r * kZodiacalColumns + c] = std::log(given) + (r < first ? kPower * std::log(from / e) : 0);
    }
  }
  return logs;
}

template <size_t kCount>
std::pair<size_t, double> place_in(const double (&nodes)[kCount], double x) {
  size_t i = 0;
  while (i + 2 < kCount && nodes[i + 1] <= x) ++i;
  return {i, std::clamp((x - nodes[i]) / (nodes[i + 1] - nodes[i]), 0.0, 1.0)};
}

// The Sun's spectrum as it counts at 0.5 um, times a factor of wavelength.
template <class Factor>
GlowSpectrum sunlight(const Factor& factor) {
  constexpr double kS10Sun = 1.28e-8;  // W/(m2 sr um) at 0.5 um
  const Curve& sun = solar_irradiance();
  const double at_500 = sun.mean(0.49, 0.51);
  std::vector<double> x{kNightLow}, y{};
  for (const double w : sun.wavelength_um())
    if (w > kNightLow && w < kNightHigh) x.push_back(w);
  x.push_back(kNightHigh);
  for (const double w : x) y.push_back(kS10Sun * sun.at(w) / at_500 * factor(w));
  return {Curve(std::move(x), std::move(y), Outside::zero)};
}

}  // namespace

double zodiacal_s10(double longitude_from_sun, double latitude) {
  static const std::array<double, kZodiacalRows* kZodiacalColumns> kLogs = logarithms();
  double turn = std::fabs(std::remainder(longitude_from_sun, 2 * kPi)) / kDegree;
  turn = std::min(turn, 180.0);
  const auto [r, v] = place_in(kLongitude, turn);
  const auto [c, u] = place_in(kLatitude, std::min(90.0, std::fabs(latitude) / kDegree));
  const double *low = &kLogs[r * kZodiacalColumns + c], *high = low + kZodiacalColumns;
  return std::exp((1 - v) * ((1 - u) * low[0] + u * low[1]) + v * ((1 - u) * high[0] + u * high[1]));
}

double zodiacal_reddening(double longitude_from_sun, double latitude) {
  const double e = std::acos(std::clamp(std::cos(longitude_from_sun) * std::cos(latitude), -1.0, 1.0)) / kDegree;
  return 1.2 - 0.3 * std::clamp((e - 30) / 60, 0.0, 1.0);
}

const GlowSpectrum& zodiacal_spectrum() {
  static const GlowSpectrum spectrum = sunlight([](double) { return 1.0; });
  return spectrum;
}

const GlowSpectrum& zodiacal_red() {
  static const GlowSpectrum red = sunlight([](double w) { return std::log10(w / 0.5) * (w < 0.5 ? 1.0 : 2.0 / 3); });
  return red;
}

}  // namespace suite
