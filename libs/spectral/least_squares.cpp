// Based on: C. Lawson & R. Hanson, "Solving least squares problems", 1974: chapters 10 and 11 (Householder), 23 (NNLS).
#include "spectral/least_squares.h"

#include <algorithm>
#include <cmath>
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

// Solves for the chosen columns and drops those that would not stay positive.
void settle(const std::function<std::span<const double>(size_t)>& column, std::span<const double> b,
            NonNegativeFit& fit) {
  while (!fit.chosen.empty()) {
    std::vector<std::vector<double>> columns;
    for (const size_t j : fit.chosen) columns.emplace_back(column(j).begin(), column(j).end());
    const std::vector<double> wanted = least_squares(columns, b);
    // Go towards the solution as far as nothing turns negative.
    double step = 1;
    for (size_t k = 0; k < wanted.size(); ++k)
      if (!(wanted[k] > 0)) step = std::min(step, fit.x[k] / (fit.x[k] - wanted[k]));
    for (size_t k = 0; k < wanted.size(); ++k) fit.x[k] += step * (wanted[k] - fit.x[k]);
    if (step == 1 && std::all_of(wanted.begin(), wanted.end(), [](double v) { return v > 0; })) return;
    size_t kept = 0;
    for (size_t k = 0; k < wanted.size(); ++k) {
      if (!(wanted[k] > 0) && fit.x[k] <= 1e-12) continue;
      fit.chosen[kept] = fit.chosen[k], fit.x[kept++] = fit.x[k];
    }
    if (kept == fit.chosen.size()) return;
    fit.chosen.resize(kept), fit.x.resize(kept);
  }
}

}  // namespace

std::vector<double> least_squares(const std::vector<std::vector<double>>& columns, std::span<const double> b) {
  const size_t n = columns.size(), m = b.size();
  std::vector<std::vector<double>> a = columns;
  std::vector<double> y(b.begin(), b.end()), diagonal(n, 0.0), x(n, 0.0);
  const size_t ranks = std::min(n, m);
  for (size_t k = 0; k < ranks; ++k) {
    const double whole = std::sqrt(dot(a[k], a[k])), norm = std::sqrt(dot(a[k], a[k], k));
    if (!(norm > 1e-12 * whole)) continue;
    diagonal[k] = a[k][k] > 0 ? -norm : norm;
    a[k][k] -= diagonal[k];
    const double square = dot(a[k], a[k], k);
    const auto reflect = [&](std::vector<double>& v) {
      const double t = 2 * dot(a[k], v, k) / square;
      for (size_t i = k; i < m; ++i) v[i] -= t * a[k][i];
    };
    for (size_t j = k + 1; j < n; ++j) reflect(a[j]);
    reflect(y);
  }
  for (size_t k = ranks; k-- > 0;) {
    if (diagonal[k] == 0) continue;
    double sum = y[k];
    for (size_t j = k + 1; j < ranks; ++j) sum -= a[j][k] * x[j];
    x[k] = sum / diagonal[k];
  }
  return x;
}

void fit_non_negative(std::span<const size_t> candidates, const std::function<std::span<const double>(size_t)>& column,
                      std::span<const double> b, const std::function<bool(size_t)>& preferred,
                      const std::function<bool(const NonNegativeFit&)>& done, size_t most, NonNegativeFit& fit) {
  constexpr double kPreference = 3;
  settle(column, b, fit);
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
    settle(column, b, fit);
  }
}

}  // namespace suite
