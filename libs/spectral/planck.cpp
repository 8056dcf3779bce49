#include "spectral/planck.h"

#include <cmath>

#include "math/vec.h"

namespace suite {

namespace {
constexpr double kC2 = kPlanckConstant * kSpeedOfLight / kBoltzmann * 1e6;  // um K
// 2 h c^2 in W um^4 / m2 / sr: 1e24 from um^-5 per m and 1e-6 per um folded together.
constexpr double kC1 = 2 * kPlanckConstant * kSpeedOfLight * kSpeedOfLight * 1e24;

// Integral of t^3/(e^t - 1) from x to infinity.
double tail_integral(double x) {
  if (x >= 1.5) {
    // sum over n of e^-nx (x^3/n + 3x^2/n^2 + 6x/n^3 + 6/n^4)
    double sum = 0;
    for (int n = 1; n < 60; ++n) {
      const double k = 1.0 / n, term = std::exp(-n * x) * k * (x * x * x + k * (3 * x * x + k * (6 * x + 6 * k)));
      sum += term;
      if (term < 1e-18 * sum) break;
    }
    return sum;
  }
  // pi^4/15 minus the integral from 0 to x of the Bernoulli series t^2 (1 - t/2 + t^2/12 - ...).
  const double x2 = x * x;
  static constexpr double c[] = {1.0 / 60, -1.0 / 5040, 1.0 / 272160, -1.0 / 13305600, 1.0 / 622702080, -691.0 / 19615115520000.0, 1.0 / 1270312243200.0, -3617.0 / 202741834014720000.0};
  double head = 1.0 / 3 - x / 8, power = x2;
  for (const double k : c) head += k * power, power *= x2;
  constexpr double whole = kPi * kPi * kPi * kPi / 15;
  return whole - x * x2 * head;
}
}  // namespace

double planck_radiance(double w, double kelvin) {
  if (!(kelvin > 0)) return 0;
  const double x = kC2 / (w * kelvin);
  if (x > 745) return 0;  // e^-745 is the smallest double
  // For large x, exp(x) overflows before the product underflows: use exp(-x) there.
  const double shape = x > 40 ? std::exp(-x) : 1 / std::expm1(x);
  return kC1 / (w * w * w * w * w) * shape;
}

double planck_band_radiance(double low, double high, double kelvin) {
  if (!(kelvin > 0) || !(high > low)) return 0;
  const double near = kC2 / (high * kelvin), far = low > 0 ? kC2 / (low * kelvin) : INFINITY;
  const double t = kelvin, scale = kStefanBoltzmann * t * t * t * t / kPi * (15 / (kPi * kPi * kPi * kPi));
  // Narrow bands cancel in the difference of tails; Gauss-Legendre over the band is exact there.
  if ((high - low) < 0.05 * high) {
    static constexpr double node[5] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640, -0.9061798459386640};
    static constexpr double weight[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891, 0.2369268850561891};
    double sum = 0;
    const int pieces = 1 + static_cast<int>((far - near) / 2);  // the integrand falls as e^-x
    const double step = (high - low) / pieces;
    for (int p = 0; p < pieces; ++p)
      for (int i = 0; i < 5; ++i) sum += weight[i] * planck_radiance(low + (p + 0.5 + 0.5 * node[i]) * step, kelvin);
    return 0.5 * step * sum;
  }
  return scale * (tail_integral(near) - (std::isfinite(far) ? tail_integral(far) : 0.0));
}

double brightness_temperature(double w, double radiance) {
  return kC2 / (w * std::log1p(kC1 / (w * w * w * w * w * radiance)));
}

}  // namespace suite
