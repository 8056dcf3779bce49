#include "scheduler/plan.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {

// Variance of one path and mean of a problem's pilot at one band.
struct Moments {
  double variance = 0, mean = 0;
};
Moments moments_of(const Accumulators& pilot, size_t problem, size_t band) {
  Moments m;
  double error = 0;
  pilot.estimate(problem, band, m.mean, error);
  m.variance = error * error * pilot.paths(problem);
  return m;
}

double need(double variance, double mean, double floor) {
  const double scale = std::max(mean, floor);
  if (!(variance > 0)) return 0;
  return scale > 0 ? variance / (scale * scale) : INFINITY;
}

// Pools one band over each problem's neighbours and keeps the larger need.
void pool_band(const Capture& capture, const std::vector<Moments>& of, double floor, std::vector<double>& needs) {
  constexpr long reach = 2;
  const long columns = capture.columns, rows = capture.rows;
  for (long r = 0; r < rows; ++r)
    for (long k = 0; k < columns; ++k) {
      double variance = 0, mean = 0;
      int n = 0;
      for (long y = std::max(0L, r - reach); y <= std::min(rows - 1, r + reach); ++y)
        for (long x = std::max(0L, k - reach); x <= std::min(columns - 1, k + reach); ++x) {
          if (y == r && x == k) continue;
          variance += of[static_cast<size_t>(y * columns + x)].variance;
          mean += of[static_cast<size_t>(y * columns + x)].mean;
          ++n;
        }
      double& here = needs[static_cast<size_t>(r * columns + k)];
      here = std::max(here, need(variance / n, mean / n, floor));
    }
}

}  // namespace

bool has_neighbours(const Capture& capture) { return capture.neighbours && capture.problems() >= 2; }

std::vector<double> needs_of(const Capture& capture, const Accumulators& pilot, std::span<const size_t> judged,
                             double absolute_floor) {
  std::vector<double> needs(capture.problems(), 0.0);
  std::vector<Moments> of(capture.problems());
  for (const size_t band : judged) {
    for (size_t i = 0; i < of.size(); ++i) of[i] = moments_of(pilot, i, band);
    pool_band(capture, of, absolute_floor, needs);
  }
  return needs;
}

std::vector<double> own_needs_of(const Accumulators& pilot, std::span<const size_t> judged, double absolute_floor) {
  std::vector<double> needs(pilot.problems(), 0.0);
  for (const size_t band : judged)
    for (size_t i = 0; i < needs.size(); ++i) {
      const Moments m = moments_of(pilot, i, band);
      needs[i] = std::max(needs[i], need(m.variance, m.mean, absolute_floor));
    }
  return needs;
}

std::vector<uint32_t> paths_for(std::span<const double> needs, const Convergence& goal) {
  std::vector<uint32_t> plan(needs.size(), goal.max_paths);
  if (!(goal.relative_error > 0)) return plan;
  for (size_t i = 0; i < plan.size(); ++i) {
    const double wanted = std::ceil(std::min(needs[i] / (goal.relative_error * goal.relative_error), 1e12) / 4) * 4;
    plan[i] = static_cast<uint32_t>(
        std::clamp(wanted, static_cast<double>(goal.min_paths), static_cast<double>(goal.max_paths)));
  }
  return plan;
}

uint32_t cap_for_total(std::span<const double> needs, const Convergence& goal, double total) {
  uint32_t low = goal.min_paths, high = goal.max_paths;
  while (low < high) {
    Convergence tried = goal;
    tried.max_paths = low + (high - low + 1) / 2;
    double sum = 0;
    for (const uint32_t n : paths_for(needs, tried)) sum += n;
    if (sum <= total)
      low = tried.max_paths;
    else
      high = tried.max_paths - 1;
  }
  return low;
}

}  // namespace suite
