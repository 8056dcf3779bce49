#include "scheduler/plan.h"

#include <algorithm>
#include <cmath>

namespace suite {

std::vector<uint32_t> plan_paths(const Capture& capture, const Accumulators& pilot, size_t band) {
  const Convergence& c = capture.convergence;
  const long columns = capture.columns, rows = capture.rows;
  std::vector<uint32_t> plan(capture.problems(), c.max_paths);
  if (columns * rows < 2 || !capture.neighbours) return plan;
  // Variance of one path and mean of every problem's pilot.
  std::vector<double> variance(plan.size()), mean(plan.size());
  for (size_t i = 0; i < plan.size(); ++i) {
    double error = 0;
    pilot.estimate(i, band, mean[i], error);
    variance[i] = error * error * pilot.paths(i);
  }
  constexpr long reach = 2;
  for (long r = 0; r < rows; ++r)
    for (long k = 0; k < columns; ++k) {
      double v = 0, m = 0;
      int n = 0;
      for (long y = std::max(0L, r - reach); y <= std::min(rows - 1, r + reach); ++y)
        for (long x = std::max(0L, k - reach); x <= std::min(columns - 1, k + reach); ++x) {
          if (y == r && x == k) continue;
          v += variance[static_cast<size_t>(y * columns + x)];
          m += mean[static_cast<size_t>(y * columns + x)];
          ++n;
        }
      const double target = c.relative_error * std::max(m / n, c.absolute_floor);
      const double wanted = target > 0 ? v / n / (target * target) : (v > 0 ? 1e18 : 0);
      const double step = pilot.scrambles();
      const double rounded = std::ceil(std::min(wanted, 1e12) / step) * step;
      plan[static_cast<size_t>(r * columns + k)] = static_cast<uint32_t>(std::clamp(rounded, static_cast<double>(c.min_paths), static_cast<double>(c.max_paths)));
    }
  return plan;
}

}  // namespace suite
