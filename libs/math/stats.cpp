#include "math/stats.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace suite {

namespace {

// x^a e^-x / Gamma(a)
double gamma_front(double a, double x) { return std::exp(-x + a * std::log(x) - std::lgamma(a)); }

// P by its power series; converges fast for x < a + 1.
double gamma_series(double a, double x) {
  double term = 1 / a, sum = term;
  for (int n = 1; n < 100000 && std::fabs(term) > 1e-17 * std::fabs(sum); ++n) sum += term *= x / (a + n);
  return std::min(1.0, gamma_front(a, x) * sum);
}

// Q by Lentz's continued fraction; converges fast for x >= a + 1.
double gamma_fraction(double a, double x) {
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int i = 1; i < 100000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = an * d + b;
    d = 1 / (std::fabs(d) < 1e-300 ? 1e-300 : d);
    c = b + an / c;
    if (std::fabs(c) < 1e-300) c = 1e-300;
    h *= d * c;
    if (std::fabs(d * c - 1) < 1e-16) break;
  }
  return std::min(1.0, gamma_front(a, x) * h);
}

}  // namespace

double gamma_p(double a, double x) {
  if (!(x > 0)) return 0;
  return x < a + 1 ? gamma_series(a, x) : 1 - gamma_fraction(a, x);
}

double gamma_q(double a, double x) {
  if (!(x > 0)) return 1;
  return x < a + 1 ? 1 - gamma_series(a, x) : gamma_fraction(a, x);
}

double chi_square_tail(double x, double k) { return gamma_q(k / 2, x / 2); }
double normal_two_sided(double z) { return std::erfc(std::fabs(z) / std::sqrt(2.0)); }

namespace {
// P(|T| <= t) for n degrees of freedom in closed form (Abramowitz & Stegun 26.7.3 and 26.7.4), which has n / 2 terms;
// of many degrees within 2e-7 (26.7.8).
double student_central(double t, int n) {
  constexpr int kMany = 1000;
  if (n > kMany) return 1 - normal_two_sided(t * (1 - 0.25 / n) / std::sqrt(1 + t * t / (2.0 * n)));
  const double theta = std::atan(t / std::sqrt(static_cast<double>(n))), c = std::cos(theta), s = std::sin(theta);
  double term = n % 2 ? c : 1, sum = n == 1 ? 0 : term;
  for (int k = n % 2 ? 3 : 2; k < n; k += 2) sum += term *= c * c * (k - 1.0) / k;
  constexpr double two_over_pi = 0.63661977236758134308;
  return n % 2 ? two_over_pi * (theta + (n > 1 ? s * sum : 0)) : s * sum;
}
}  // namespace

double student_t_quantile(double confidence, int n) {
  double low = 0, high = 1;
  while (student_central(high, n) < confidence && high < 1e12) high *= 2;
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (low + high);
    if (mid == low || mid == high) break;
    (student_central(mid, n) < confidence ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

double chi_square_test(std::span<const double> observed, std::span<const double> expected, double pool_below,
                       int* degrees) {
  // Pool the rarest cells together until every pooled cell is expected often enough for the statistic to be chi-square.
  std::vector<size_t> order(expected.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  double statistic = 0, pooled_expected = 0, pooled_observed = 0;
  int cells = 0;
  for (const size_t i : order) {
    if (expected[i] == 0) {
      if (observed[i] > 0) {  // impossible events happened
        if (degrees) *degrees = 0;
        return 0;
      }
      continue;
    }
    pooled_expected += expected[i];
    pooled_observed += observed[i];
    if (pooled_expected >= pool_below) {
      statistic += (pooled_observed - pooled_expected) * (pooled_observed - pooled_expected) / pooled_expected;
      ++cells;
      pooled_expected = pooled_observed = 0;
    }
  }
  if (pooled_expected > 0) {
    statistic += (pooled_observed - pooled_expected) * (pooled_observed - pooled_expected) / pooled_expected;
    ++cells;
  }
  if (degrees) *degrees = cells - 1;
  return cells < 2 ? 1.0 : chi_square_tail(statistic, cells - 1);
}

}  // namespace suite
