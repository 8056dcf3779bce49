#include "light/perez_sky.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace suite {

namespace {

// Perez, Seals & Michalsky 1993, table 1: x1..x4 of a, b, c, d, e for eight bins of clearness.
constexpr double kClearness[7] = {1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};
constexpr double kPerez[8][5][4] = {{{1.3525, -0.2576, -0.2690, -1.4366},
                                     {-0.7670, 0.0007, 1.2734, -0.1233},
                                     {2.8000, 0.6004, 1.2375, 1.0000},
                                     {1.8734, 0.6297, 0.9738, 0.2809},
                                     {0.0356, -0.1246, -0.5718, 0.9938}},
                                    {{-1.2219, -0.7730, 1.4148, 1.1016},
                                     {-0.2054, 0.0367, -3.9128, 0.9156},
                                     {6.9750, 0.1774, 6.4477, -0.1239},
                                     {-1.5798, -0.5081, -1.7812, 0.1080},
                                     {0.2624, 0.0672, -0.2190, -0.4285}},
                                    {{-1.1000, -0.2515, 0.8952, 0.0156},
                                     {0.2782, -0.1812, -4.5000, 1.1766},
                                     {24.7219, -13.0812, -37.7000, 34.8438},
                                     {-5.0000, 1.5218, 3.9229, -2.6204},
                                     {-0.0156, 0.1597, 0.4199, -0.5562}},
                                    {{-0.5484, -0.6654, -0.2672, 0.7117},
                                     {0.7234, -0.6219, -5.6812, 2.6297},
                                     {33.3389, -18.3000, -62.2500, 52.0781},
                                     {-3.5000, 0.0016, 1.1477, 0.1062},
                                     {0.4659, -0.3296, -0.0876, -0.0329}},
                                    {{-0.6000, -0.3566, -2.5000, 2.3250},
                                     {0.2937, 0.0496, -5.6812, 1.8415},
                                     {21.0000, -4.7656, -21.5906, 7.2492},
                                     {-3.5000, -0.1554, 1.4062, 0.3988},
                                     {0.0032, 0.0766, -0.0656, -0.1294}},
                                    {{-1.0156, -0.3670, 1.0078, 1.4051},
                                     {0.2875, -0.5328, -3.8500, 3.3750},
                                     {14.0000, -0.9999, -7.1406, 7.5469},
                                     {-3.4000, -0.1078, -1.0750, 1.5702},
                                     {-0.0672, 0.4016, 0.3017, -0.4844}},
                                    {{-1.0000, 0.0211, 0.5025, -0.5119},
                                     {-0.3000, 0.1922, 0.7023, -1.6317},
                                     {19.0000, -5.0000, 1.2438, -1.9094},
                                     {-4.0000, 0.0250, 0.3844, 0.2656},
                                     {1.0468, -0.3788, -2.4517, 1.4656}},
                                    {{-1.0500, 0.0289, 0.4260, 0.3590},
                                     {-0.3250, 0.1156, 0.7781, 0.0025},
                                     {31.0625, -14.5000, -46.1148, 55.3750},
                                     {-7.2312, 0.4050, 13.3500, 0.6234},
                                     {1.5000, -0.6426, 1.8564, 0.5636}}};

}  // namespace

PerezSky::PerezSky(double zenith, double direct, double diffuse, double extraterrestrial, double air_mass) {
  const double cube = 1.041 * zenith * zenith * zenith;
  const double clearness = ((diffuse + direct) / diffuse + cube) / (1 + cube);
  double brightness = air_mass * diffuse / extraterrestrial;
  const auto bin = static_cast<size_t>(std::upper_bound(std::begin(kClearness), std::end(kClearness), clearness) -
                                       std::begin(kClearness));
  // Outside of the fitted range the coefficients would turn the sky upside down.
  brightness = std::clamp(brightness, clearness > 1.065 && clearness < 2.8 ? 0.2 : 0.01, 0.6);
  for (int i = 0; i < 5; ++i) {
    const double* x = kPerez[bin][i];
    k_[i] = x[0] + x[1] * zenith + brightness * (x[2] + x[3] * zenith);
  }
  if (bin == 0) {  // the darkest skies have their own c and d
    const double *c = kPerez[0][2], *d = kPerez[0][3];
    k_[2] = std::exp(std::pow(brightness * (c[0] + c[1] * zenith), c[2])) - c[3];
    k_[3] = -std::exp(brightness * (d[0] + d[1] * zenith)) + d[2] + brightness * d[3];
  }
}

double PerezSky::at(double cos_zenith, double to_sun) const {
  const double gradation = 1 + k_[0] * std::exp(k_[1] / std::max(cos_zenith, 0.01));
  const double c = std::cos(to_sun), indicatrix = 1 + k_[2] * std::exp(k_[3] * to_sun) + k_[4] * c * c;
  return std::max(0.0, gradation * indicatrix);
}

}  // namespace suite
