#include "detection/bin_interval.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "math/stats.h"

namespace suite {

// With a the skewness over the root of n and T Student's statistic, g(T) = T + a T^2 / 3 + a^2 T^3 / 27 + a / 6 is
// distributed as if there were no skewness. This is the inverse of g.
static double untransformed(double g, double a) {
  if (std::fabs(a) < 1e-6) return g;
  return 3 / a * (std::cbrt(1 + a * (g - a / 6)) - 1);
}

BinInterval bin_interval(double mean, double error, double skewness, int scrambles, double confidence) {
  SUITE_CHECK_LE(2, scrambles);
  const double t = student_t_quantile(confidence, scrambles - 1), a = skewness / std::sqrt(double(scrambles));
  return {std::max(0.0, mean - error * untransformed(t, a)), mean - error * untransformed(-t, a)};
}

BinInterval interval_of_sum(const BinPart& a, const BinPart& b) {
  const double mean = a.mean + b.mean;
  return {std::max(0.0, mean - std::hypot(a.mean - a.interval.low, b.mean - b.interval.low)),
          mean + std::hypot(a.interval.high - a.mean, b.interval.high - b.mean)};
}

double skewness_of(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  if (n < 3) return 0;
  double mean = 0, squares = 0, cubes = 0;
  for (const double v : values) mean += v / n;
  for (const double v : values) squares += (v - mean) * (v - mean), cubes += (v - mean) * (v - mean) * (v - mean);
  const double deviation = std::sqrt(squares / (n - 1));
  if (!(deviation > 1e-12 * std::fabs(mean))) return 0;
  return cubes * n / ((n - 1) * (n - 2)) / (deviation * deviation * deviation);
}

}  // namespace suite
