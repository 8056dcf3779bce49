// Based on: C. Lawson & R. Hanson, "Solving least squares problems", 1974: chapters 10 and 11 (Householder), 23 (NNLS).
#include "spectral/least_squares.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace suite {

namespace {

double dot(std::span<const double> a, std::span<const double> b, size_t from = 0) {
  double sum = 0;
  for (size_t i = from; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

std::vector<double> residual(const std::function<std::span<const double>(size_t)>& column, std::span<const double> b,
                             const NonNegativeFit& fit) {
  std::vector<double> r(b.begin(), b.end());
  for (size_t k = 0; k < fit.chosen.size(); ++k) {
    const std::span<const double> a = column(fit.chosen[k]);
    for (size_t i = 0; i < r.size(); ++i) r[i] -= fit.x[k] * a[i];
  }
  return r;
}

// Columns under Householder reflections, one after the other: what comes to the end leaves those before it as they are.
class Factors {
 public:
  explicit Factors(std::span<const double> b) : b_(b) {}

  // `column(j)` for all of `added`. Columns that come together are reflected together: each one's sum waits for its
  // own last addition only, and its bits do not depend on its company.
  void add(std::span<const size_t> added, const std::function<std::span<const double>(size_t)>& column) {
    const size_t first = a_.size(), ranks = std::min(first + added.size(), b_.size());
    for (const size_t j : added) a_.emplace_back(column(j).begin(), column(j).end());
    diagonal_.resize(a_.size(), 0.0), square_.resize(a_.size(), 0.0);
    for (size_t k = 0; k < ranks; ++k) {
      if (k >= first) make_reflection(k);
      reflect_from(k, std::max(k + 1, first));
    }
  }
  void keep_first(size_t n) { a_.resize(n), diagonal_.resize(n), square_.resize(n); }
  size_t size() const { return a_.size(); }

  std::vector<double> solve() const {
    const size_t ranks = std::min(a_.size(), b_.size());
    std::vector<double> y(b_.begin(), b_.end()), x(a_.size(), 0.0);
    for (size_t k = 0; k < ranks; ++k) reflect(k, y);
    for (size_t k = ranks; k-- > 0;) {
      if (diagonal_[k] == 0) continue;
      double sum = y[k];
      for (size_t j = k + 1; j < ranks; ++j) sum -= a_[j][k] * x[j];
      x[k] = sum / diagonal_[k];
    }
    return x;
  }

 private:
  void make_reflection(size_t k) {
    std::vector<double>& v = a_[k];
    const double whole = std::sqrt(dot(v, v)), norm = std::sqrt(dot(v, v, k));
    if (!(norm > 1e-12 * whole)) return;
    diagonal_[k] = v[k] > 0 ? -norm : norm;
    v[k] -= diagonal_[k];
    square_[k] = dot(v, v, k);
  }
  void reflect(size_t k, std::vector<double>& v) const {
    if (diagonal_[k] == 0) return;
    const double t = 2 * dot(a_[k], v, k) / square_[k];
    for (size_t i = k; i < v.size(); ++i) v[i] -= t * a_[k][i];
  }
  void reflect_from(size_t k, size_t j) {
    if (diagonal_[k] == 0) return;
    for (; j + 4 <= a_.size(); j += 4) {
      const double* const u = a_[k].data();
      double *const v0 = a_[j].data(), *const v1 = a_[j + 1].data(), *const v2 = a_[j + 2].data(),
                    *const v3 = a_[j + 3].data();
      double s0 = 0, s1 = 0, s2 = 0, s3 = 0;
      for (size_t i = k; i < b_.size(); ++i)
        s0 += u[i] * v0[i], s1 += u[i] * v1[i], s2 += u[i] * v2[i], s3 += u[i] * v3[i];
      const double t0 = 2 * s0 / square_[k], t1 = 2 * s1 / square_[k], t2 = 2 * s2 / square_[k],
                   t3 = 2 * s3 / square_[k];
      for (size_t i = k; i < b_.size(); ++i)
        v0[i] -= t0 * u[i], v1[i] -= t1 * u[i], v2[i] -= t2 * u[i], v3[i] -= t3 * u[i];
    }
    for (; j < a_.size(); ++j) reflect(k, a_[j]);
  }

  std::span<const double> b_;
  std::vector<std::vector<double>> a_;
  std::vector<double> diagonal_, square_;  // 0: depends on the columns before it
};

// Solves for the chosen columns, the first of which stand in `factors`, and drops those that would not stay positive.
void settle(const std::function<std::span<const double>(size_t)>& column, Factors& factors, NonNegativeFit& fit) {
  while (!fit.chosen.empty()) {
    factors.add(std::span(fit.chosen).subspan(factors.size()), column);
    const std::vector<double> wanted = factors.solve();
    // Go towards the solution as far as nothing turns negative.
    double step = 1;
    for (size_t k = 0; k < wanted.size(); ++k)
      if (!(wanted[k] > 0)) step = std::min(step, fit.x[k] / (fit.x[k] - wanted[k]));
    for (size_t k = 0; k < wanted.size(); ++k) fit.x[k] += step * (wanted[k] - fit.x[k]);
    if (step == 1 && std::all_of(wanted.begin(), wanted.end(), [](double v) { return v > 0; })) return;
    size_t kept = 0, same = wanted.size();
    for (size_t k = 0; k < wanted.size(); ++k) {
      if (!(wanted[k] > 0) && fit.x[k] <= 1e-12) {
        same = std::min(same, k);
        continue;
      }
      fit.chosen[kept] = fit.chosen[k], fit.x[kept++] = fit.x[k];
    }
    if (kept == fit.chosen.size()) return;
    fit.chosen.resize(kept), fit.x.resize(kept);
    factors.keep_first(same);
  }
}

}  // namespace

std::vector<double> least_squares(const std::vector<std::vector<double>>& columns, std::span<const double> b) {
  std::vector<size_t> all(columns.size());
  std::iota(all.begin(), all.end(), size_t{0});
  Factors factors(b);
  factors.add(all, [&](size_t j) { return std::span<const double>(columns[j]); });
  return factors.solve();
}

void fit_non_negative(std::span<const size_t> candidates, const std::function<std::span<const double>(size_t)>& column,
                      std::span<const double> b, const std::function<bool(size_t)>& preferred,
                      const std::function<bool(const NonNegativeFit&)>& done, size_t most, NonNegativeFit& fit) {
  constexpr double kPreference = 3;
  Factors factors(b);
  settle(column, factors, fit);
  double before = INFINITY;
  while (!done(fit) && fit.chosen.size() < most) {
    const std::vector<double> r = residual(column, b, fit);
    const double left = dot(r, r);
    if (!(left < before * (1 - 1e-9))) return;  // nothing improves any more
    before = left;
    std::optional<size_t> best;
    double steepest = 1e-14 * std::sqrt(left);
    for (const size_t j : candidates) {
      const std::span<const double> a = column(j);
      const double square = dot(a, a);
      if (!(square > 0)) continue;
      const double slope = dot(a, r) / std::sqrt(square) * (preferred(j) ? kPreference : 1);
      if (slope > steepest && std::find(fit.chosen.begin(), fit.chosen.end(), j) == fit.chosen.end())
        steepest = slope, best = j;
    }
    if (!best) return;
    fit.chosen.push_back(*best), fit.x.push_back(0);
    settle(column, factors, fit);
  }
}

}  // namespace suite
