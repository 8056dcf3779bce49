#include "estimate/plan.h"

#include <algorithm>
#include <cmath>

#include "sensor/polarimetry.h"

namespace suite {

namespace {

// Variance of one path and mean of a problem's pilot at one band.
struct Moments {
  double variance = 0, mean = 0;
};
// Standard error of the degree of linear polarisation, times the radiance; 0 where no light was seen, infinite where
// one group of samples alone saw any.
double error_of_degree(const Accumulators& pilot, size_t problem, const JudgedBand& judge) {
  const size_t values[3] = {judge.band, judge.degree->q, judge.degree->u};
  double S[3], error[3], C[6];
  for (size_t a = 0; a < 3; ++a) pilot.estimate(problem, values[a], S[a], error[a]);
  if (!(S[0] > 0)) return 0;
  if (std::isinf(error[0])) return INFINITY;
  for (size_t a = 0, at = 0; a < 3; ++a)
    for (size_t b = a; b < 3; ++b) C[at++] = pilot.covariance(problem, values[a], values[b]);
  return linear_polarisation(S, C).degree_error * S[0];
}

Moments moments_of(const Accumulators& pilot, size_t problem, const JudgedBand& judge) {
  Moments m;
  double error = 0;
  pilot.estimate(problem, judge.band, m.mean, error);
  if (judge.degree) error = error_of_degree(pilot, problem, judge);
  m.variance = error * error * pilot.paths(problem);
  return m;
}

double need(const JudgedBand& judge, double variance, double mean, double floor) {
  if (!(variance > 0)) return 0;
  const double square = judge.square_scale(mean, floor);
  return square > 0 ? judge.weight * variance / square : INFINITY;
}

// Pools one band over each problem's neighbours and keeps the larger need.
void pool_band(const Capture& capture, const std::vector<Moments>& of, const JudgedBand& judge, const Goals& goals,
               std::vector<double>& needs) {
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
      const size_t problem = static_cast<size_t>(r * columns + k);
      needs[problem] = std::max(needs[problem], need(judge, variance / n, mean / n, goals.of(problem).absolute_floor));
    }
}

}  // namespace

double JudgedBand::square_scale(double radiance, double floor) const {
  if (noise) return noise->constant + noise->linear * std::max(radiance, 0.0);
  const double scale = std::max(radiance, floor);
  return scale > 0 ? scale * scale : 0;
}

bool has_neighbours(const Capture& capture) { return capture.neighbours && capture.problems() >= 2; }

std::vector<double> needs_of(const Capture& capture, const Accumulators& pilot, std::span<const JudgedBand> judged,
                             const Goals& goals) {
  std::vector<double> needs(capture.problems(), 0.0);
  std::vector<Moments> of(capture.problems());
  for (const JudgedBand& judge : judged) {
    for (size_t i = 0; i < of.size(); ++i) of[i] = moments_of(pilot, i, judge);
    pool_band(capture, of, judge, goals, needs);
  }
  return needs;
}

std::vector<double> own_needs_of(const Accumulators& pilot, std::span<const JudgedBand> judged, const Goals& goals) {
  std::vector<double> needs(pilot.problems(), 0.0);
  for (const JudgedBand& judge : judged)
    for (size_t i = 0; i < needs.size(); ++i) {
      const Moments m = moments_of(pilot, i, judge);
      needs[i] = std::max(needs[i], need(judge, m.variance, m.mean, goals.of(i).absolute_floor));
    }
  return needs;
}

std::vector<uint32_t> paths_for(std::span<const double> needs, const Goals& goals) {
  std::vector<uint32_t> plan(needs.size());
  for (size_t i = 0; i < plan.size(); ++i) {
    const Convergence goal = goals.of(i);
    plan[i] = goal.max_paths;
    if (!(goal.relative_error > 0)) continue;
    const double wanted = std::ceil(std::min(needs[i] / (goal.relative_error * goal.relative_error), 1e12) / 4) * 4;
    plan[i] = static_cast<uint32_t>(
        std::clamp(wanted, static_cast<double>(goal.min_paths), static_cast<double>(goal.max_paths)));
  }
  return plan;
}

uint32_t cap_for_total(std::span<const double> needs, const Goals& goals, double total) {
  uint32_t low = goals.all.min_paths, high = goals.all.max_paths;
  Goals tried = goals;
  while (low < high) {
    tried.all.max_paths = low + (high - low + 1) / 2;
    double sum = 0;
    for (const uint32_t n : paths_for(needs, tried)) sum += n;
    if (sum <= total)
      low = tried.all.max_paths;
    else
      high = tried.all.max_paths - 1;
  }
  return low;
}

}  // namespace suite
