#include "detection/variates.h"

#include <cmath>

#include "sensor/detector.h"

namespace suite {

double gamma_variate(double shape, double scale, Pcg32& random) {
  if (shape < 1) {
    const double u = 1 - random.uniform();
    return gamma_variate(shape + 1, scale, random) * std::pow(u, 1 / shape);
  }
  const double d = shape - 1.0 / 3, c = 1 / std::sqrt(9 * d);
  for (;;) {
    const double x = normal(random), root = 1 + c * x, v = root * root * root;
    if (v <= 0) continue;
    const double u = 1 - random.uniform();
    if (std::log(u) < 0.5 * x * x + d - d * v + d * std::log(v)) return d * v * scale;
  }
}

double exponential_variate(double mean, Pcg32& random) { return -mean * std::log(1 - random.uniform()); }

double excess_noise(double k, double gain) { return k * gain + (1 - k) * (2 - 1 / gain); }

double avalanche(double primaries, double gain, double excess, Pcg32& random) {
  if (!(primaries > 0)) return 0;
  if (!(excess > 1)) return primaries * gain;
  return gamma_variate(primaries / (excess - 1), gain * (excess - 1), random);
}

}  // namespace suite
