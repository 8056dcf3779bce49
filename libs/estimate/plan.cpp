#include "estimate/plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sensor/polarimetry.h"

namespace suite {

namespace {

// Variance of one path and mean of a problem's pilot at one band.
struct Moments {
  double variance = 0, mean = 0;
};
// Means of I, Q and U and the covariances of one path (sensor/polarimetry.h) of a pilot, or sums of them.
struct StokesMoments {
  double S[3] = {}, C[6] = {};
  void add(const StokesMoments& other) {
    for (size_t k = 0; k < 3; ++k) S[k] += other.S[k];
    for (size_t k = 0; k < 6; ++k) C[k] += other.C[k];
  }
};
// Degree of linear polarisation of sums of I, Q and U; 0 without light.
double degree_of(const std::array<double, 3>& sums) { return sums[0] > 0 ? std::hypot(sums[1], sums[2]) / sums[0] : 0; }

// Standard error of the degree of linear polarisation, times the radiance; 0 where no light was seen, infinite where
// one scramble alone has samples. By the jackknife over the scrambles (B. Efron, "The Jackknife, the Bootstrap and
// Other Resampling Plans", 1982, section 3): where one scramble brings most of the light of a short pilot, the degree
// follows that scramble, and deviations from the degree of all of them show half of the variance.
double error_of_degree(const Accumulators& pilot, size_t problem, const JudgedBand& judge) {
  const size_t values[3] = {judge.band, judge.degree->q, judge.degree->u};
  std::array<double, 3> all{};
  int used = 0;
  for (int s = 0; s < pilot.scrambles(); ++s) {
    for (size_t a = 0; a < 3; ++a) all[a] += pilot.sums(problem, s)[values[a]];
    used += pilot.accepted(problem, s) > 0 ? 1 : 0;
  }
  if (!(all[0] > 0)) return 0;
  if (used < 2) return INFINITY;
  double squares = 0;
  for (int s = 0; s < pilot.scrambles(); ++s) {
    if (!pilot.accepted(problem, s)) continue;
    std::array<double, 3> rest = all;
    for (size_t a = 0; a < 3; ++a) rest[a] -= pilot.sums(problem, s)[values[a]];
    const double off = degree_of(rest) - degree_of(all);
    squares += off * off;
  }
  return std::sqrt(squares * (used - 1) / used) * all[0] / pilot.accepted(problem);
}

Moments moments_of(const Accumulators& pilot, size_t problem, const JudgedBand& judge) {
  Moments m;
  double error = 0;
  pilot.estimate(problem, judge.band, m.mean, error);
  if (judge.degree) error = error_of_degree(pilot, problem, judge);
  m.variance = error * error * pilot.paths(problem);
  return m;
}

StokesMoments stokes_moments_of(const Accumulators& pilot, size_t problem, const JudgedBand& judge) {
  const size_t values[3] = {judge.band, judge.degree->q, judge.degree->u};
  StokesMoments m;
  double error = 0;
  for (size_t a = 0, at = 0; a < 3; ++a) {
    pilot.estimate(problem, values[a], m.S[a], error);
    for (size_t b = a; b < 3; ++b) m.C[at++] = pilot.covariance(problem, values[a], values[b]) * pilot.paths(problem);
  }
  return m;
}

// The variance of one path about the degree that n problems have together, which none of them can follow by itself.
// Where their degrees differ it is too large.
double variance_about_common_degree(StokesMoments sums, int n) {
  if (!(sums.S[0] > 0)) return 0;
  for (double& s : sums.S) s /= n;
  for (double& c : sums.C) c /= n;
  return std::pow(linear_polarisation(sums.S, sums.C).degree_error * sums.S[0], 2);
}

// What a plan by the mean of n estimated variances wants beside them, so that the mean of 1 / plan is that of the true
// variance: 1 + the square of the mean's relative standard error.
double allowance(double sum, double squares, int n) { return 1 + std::max(0.0, squares / (sum * sum) - 1.0 / n); }

double need(const JudgedBand& judge, double variance, double mean, double floor) {
  if (!(variance > 0)) return 0;
  const double square = judge.square_scale(mean, floor);
  return square > 0 ? judge.weight * variance / square : INFINITY;
}

// Pools one band over each problem's neighbours and keeps the larger need. stokes: empty beside radiance.
void pool_band(const Capture& capture, const std::vector<Moments>& of, const std::vector<StokesMoments>& stokes,
               const JudgedBand& judge, const Goals& goals, std::vector<double>& needs) {
  constexpr long reach = 2;
  const long columns = capture.columns, rows = capture.rows;
  for (long r = 0; r < rows; ++r)
    for (long k = 0; k < columns; ++k) {
      double variance = 0, squares = 0, mean = 0;
      StokesMoments together;
      int n = 0;
      for (long y = std::max(0L, r - reach); y <= std::min(rows - 1, r + reach); ++y)
        for (long x = std::max(0L, k - reach); x <= std::min(columns - 1, k + reach); ++x) {
          if (y == r && x == k) continue;
          const size_t neighbour = static_cast<size_t>(y * columns + x);
          variance += of[neighbour].variance;
          squares += of[neighbour].variance * of[neighbour].variance;
          mean += of[neighbour].mean;
          if (!stokes.empty()) together.add(stokes[neighbour]);
          ++n;
        }
      const size_t problem = static_cast<size_t>(r * columns + k);
      double most = variance / n;
      if (!stokes.empty() && variance > 0 && std::isfinite(squares))
        most = std::max(most, variance_about_common_degree(together, n)) * allowance(variance, squares, n);
      needs[problem] = std::max(needs[problem], need(judge, most, mean / n, goals.of(problem).absolute_floor));
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
    std::vector<StokesMoments> stokes(judge.degree ? of.size() : 0);
    for (size_t i = 0; i < of.size(); ++i) of[i] = moments_of(pilot, i, judge);
    for (size_t i = 0; i < stokes.size(); ++i) stokes[i] = stokes_moments_of(pilot, i, judge);
    pool_band(capture, of, stokes, judge, goals, needs);
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
