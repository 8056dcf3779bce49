#include "spectral/display_colour.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

constexpr std::array<double, kUpliftedWaves> kWaves{0.38,  0.405, 0.43,  0.455, 0.48,  0.505, 0.53,  0.555, 0.58,
                                                    0.605, 0.63,  0.655, 0.68,  0.705, 0.73,  0.755, 0.78};
constexpr std::array<double, kUpliftedWaves> kRed{0.0508, 0.0505, 0.0418, 0.0108, 0, 0, 0, 0, 0.1181,
                                                  0.9276, 1,      1,      1,      1, 1, 1, 1};
constexpr std::array<double, kUpliftedWaves> kGreen{0,      0, 0, 0, 0.2081, 0.8924, 1, 1, 0.8272,
                                                    0.0678, 0, 0, 0, 0,      0,      0, 0};

}  // namespace

double linear_from_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
double srgb_from_linear(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

std::span<const double, kUpliftedWaves> uplifted_wavelengths_um() { return kWaves; }

std::array<double, kUpliftedWaves> uplifted_values(const LinearRgb& colour) {
  LinearRgb c;
  for (size_t k = 0; k < 3; ++k) c[k] = std::clamp(colour[k], 0.0, 1.0);
  std::array<double, kUpliftedWaves> value;
  for (size_t i = 0; i < kUpliftedWaves; ++i)
    value[i] = std::clamp(kRed[i] * c[0] + kGreen[i] * c[1] + (1 - kRed[i] - kGreen[i]) * c[2],
                          std::min({c[0], c[1], c[2]}), std::max({c[0], c[1], c[2]}));
  return value;
}

Curve uplifted(const LinearRgb& colour) {
  const auto value = uplifted_values(colour);
  return Curve({kWaves.begin(), kWaves.end()}, {value.begin(), value.end()}, Outside::hold);
}

}  // namespace suite
