#include "math/variates.h"

#include <cmath>

#include "math/vec.h"

namespace suite {

double normal(Pcg32& random) {
  const double u = random.uniform(), v = random.uniform();
  return std::sqrt(-2 * std::log1p(-u)) * std::cos(2 * kPi * v);
}

double poisson(double mean, Pcg32& random) {
  if (!(mean > 0)) return 0;
  if (mean < 30) {
    double p = std::exp(-mean), sum = p;
    const double u = random.uniform();
    int k = 0;
    for (; u > sum && k < 1000; sum += p) p *= mean / ++k;
    return k;
  }
  const double root = std::sqrt(mean), b = 0.931 + 2.53 * root, a = -0.059 + 0.02483 * b;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4), log_mean = std::log(mean),
               squeeze = 0.9277 - 3.6224 / (b - 2);
  for (;;) {
    const double u = random.uniform() - 0.5, v = random.uniform(), us = 0.5 - std::fabs(u);
    const double k = std::floor((2 * a / us + b) * u + mean + 0.43);
    if (us >= 0.07 && v <= squeeze) return k;
    if (k < 0 || (us < 0.013 && v > us)) continue;
    if (std::log(v * inverse_alpha / (a / (us * us) + b)) <= k * log_mean - mean - std::lgamma(k + 1)) return k;
  }
}

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

uint32_t binomial(uint32_t trials, double p, Pcg32& random) {
  constexpr uint32_t few = 24;
  uint32_t n = trials, k = 0;
  while (n > few && p > 0 && p < 1) {
    // The order statistic i of n uniform numbers is a beta variate; those on one side of it are uniform again.
    const uint32_t i = (n + 1) / 2;
    const double a = gamma_variate(i, 1, random), x = a / (a + gamma_variate(n + 1 - i, 1, random));
    if (x <= p) {
      k += i, n -= i;
      p = (p - x) / (1 - x);
    } else {
      n = i - 1;
      p /= x;
    }
  }
  if (!(p > 0)) return k;
  if (p >= 1) return k + n;
  for (uint32_t i = 0; i < n; ++i) k += random.uniform() < p;
  return k;
}

}  // namespace suite
