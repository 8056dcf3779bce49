#include "spectral/planck.h"

#include <cmath>

#include "math/vec.h"

namespace suite {

namespace {
constexpr double kC2 = kPlanckConstant * kSpeedOfLight / kBoltzmann * 1e6;  // um K
// 2 h c^2 in W um^4 / m2 / sr: 1e24 from um^-5 per m and 1e-6 per um folded together.
constexpr double kC1 = 2 * kPlanckConstant * kSpeedOfLight * kSpeedOfLight * 1e24;

constexpr double kSplit = 1;  // where the power series hands over to the exponential one

// Integral of t^3/(e^t - 1) from 0 to x <= kSplit: Bernoulli series t^2 (1 - t/2 + t^2/12 - ...).
double head_integral(double x) {
  const double x2 = x * x;
  static constexpr double c[] = {1.0 / 60,
                                 -1.0 / 5040,
                                 1.0 / 272160,
                                 -1.0 / 13305600,
                                 1.0 / 622702080,
                                 -691.0 / 19615115520000.0,
                                 1.0 / 1270312243200.0,
                                 -3617.0 / 202741834014720000.0};
  double sum = 1.0 / 3 - x / 8, power = x2;
  for (const double k : c) sum += k * power, power *= x2;
  return x * x2 * sum;
}

// The same from x >= kSplit to infinity: sum over n of e^-nx (x^3/n + 3x^2/n^2 + 6x/n^3 + 6/n^4).
double tail_integral(double x) {
  double sum = 0;
  for (int n = 1; n < 60; ++n) {
    const double k = 1.0 / n, term = std::exp(-n * x) * k * (x * x * x + k * (3 * x * x + k * (6 * x + 6 * k)));
    sum += term;
    if (term < 1e-18 * sum) break;
  }
  return sum;
}

// The same from near to far; differences are taken only between numbers of like size.
double integral_between(double near, double far) {
  if (far <= kSplit) return head_integral(far) - head_integral(near);
  const double beyond = std::isfinite(far) ? tail_integral(far) : 0;
  if (near >= kSplit) return tail_integral(near) - beyond;
  constexpr double whole = kPi * kPi * kPi * kPi / 15;
  return whole - head_integral(near) - beyond;
}
}  // namespace

double planck_radiance(double w, double kelvin) {
  if (!(kelvin > 0)) return 0;
  const double x = kC2 / (w * kelvin), scale = kC1 / (w * w * w * w * w);
  // For large x, exp(x) overflows before the product underflows: use exp(-x) there, in two halves, because exp(-x)
  // itself loses its digits below 1e-308 while the product may still be far from there.
  if (x > 40) {
    const double half = std::exp(-0.5 * x);
    return scale * half * half;
  }
  return scale / std::expm1(x);
}

double planck_steepness(double w, double kelvin) {
  const double x = kC2 / (w * kelvin);
  return x / -std::expm1(-x);
}

double planck_band_radiance(double low, double high, double kelvin) {
  if (!(kelvin > 0) || !(high > low)) return 0;
  const double near = kC2 / (high * kelvin), far = low > 0 ? kC2 / (low * kelvin) : INFINITY;
  const double t = kelvin, scale = kStefanBoltzmann * t * t * t * t / kPi * (15 / (kPi * kPi * kPi * kPi));
  if (near > 800) return 0;  // kC1 / w^5 stays below e^60 for any wavelength this could matter at
  // Narrow bands cancel in the difference of tails; Gauss-Legendre over the band is exact there.
  if ((high - low) < 0.05 * high) {
    static constexpr double node[5] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                       -0.9061798459386640};
    static constexpr double weight[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891,
                                         0.2369268850561891};
    double sum = 0;
    const int pieces = 1 + static_cast<int>(2 * (far - near));  // the integrand falls as e^-x: half an e-fold a piece
    const double step = (high - low) / pieces;
    for (int p = 0; p < pieces; ++p)
      for (int i = 0; i < 5; ++i) sum += weight[i] * planck_radiance(low + (p + 0.5 + 0.5 * node[i]) * step, kelvin);
    return 0.5 * step * sum;
  }
  return scale * integral_between(near, far);
}

double brightness_temperature(double w, double radiance) {
  return kC2 / (w * std::log1p(kC1 / (w * w * w * w * w * radiance)));
}

}  // namespace suite
