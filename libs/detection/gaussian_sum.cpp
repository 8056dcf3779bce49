#include "detection/gaussian_sum.h"

#include <algorithm>
#include <cmath>

namespace suite {

bool factor_matrix(std::vector<double>& a, size_t n) {
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i == j) {
        if (!(sum > 0) || !std::isfinite(sum)) return false;
        a[i * n + i] = std::sqrt(sum);
      } else {
        a[i * n + j] = sum / a[j * n + j];
      }
    }
  return true;
}

void solve_factored(const std::vector<double>& l, size_t n, std::vector<double>& x) {
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] /= l[i * n + i];
  }
}

double GaussianSum::value(const std::vector<double>& p, size_t k, std::vector<double>& slope) const {
  double sum = p[0];
  slope.assign(size(), 0);
  slope[0] = 1;
  for (size_t g = 0; g < pulses; ++g) {
    const double a = p[1 + 3 * g], w = p[3 + 3 * g], z = (static_cast<double>(k) - p[2 + 3 * g]) / w;
    if (std::fabs(z) > 8) continue;
    const double e = std::exp(-0.5 * z * z);
    sum += a * e;
    slope[1 + 3 * g] = e, slope[2 + 3 * g] = a * e * z / w, slope[3 + 3 * g] = a * e * z * z / w;
  }
  return sum;
}

GaussianSum::Sums GaussianSum::sums(const std::vector<double>& p, std::span<const double> signal,
                                    const SampleWeight& weight) const {
  const size_t n = size();
  Sums s{std::vector<double>(n * n, 0), std::vector<double>(n, 0), 0};
  std::vector<double> slope;
  std::vector<size_t> felt;  // parameters that a sample depends on: few, for pulses are short
  for (size_t k = 0; k < samples; ++k) {
    const double v = value(p, k, slope), w = weight(k, v), r = signal[k] - v;
    s.chi_square += w * r * r;
    felt.clear();
    for (size_t i = 0; i < n; ++i)
      if (slope[i] != 0) felt.push_back(i);
    for (const size_t i : felt) {
      s.side[i] += w * slope[i] * r;
      for (const size_t j : felt)
        if (j <= i) s.square[i * n + j] += w * slope[i] * slope[j];
    }
  }
  return s;
}

SumFit fit_gaussians(std::vector<double> p, std::span<const double> signal, const SampleWeight& weight,
                     double least_width, int steps, double enough) {
  const GaussianSum model{signal.size(), (p.size() - 1) / 3};
  const size_t n = model.size();
  GaussianSum::Sums now = model.sums(p, signal, weight);
  double damping = 1e-3;
  for (int step = 0; step < steps; ++step) {
    std::vector<double> a = now.square, x = now.side;
    for (size_t i = 0; i < n; ++i) a[i * n + i] += damping * a[i * n + i] + 1e-30;
    if (!factor_matrix(a, n)) {
      damping = std::max(10 * damping, 1e-6);
      if (damping > 1e12) return {p, now.chi_square, false};
      continue;
    }
    solve_factored(a, n, x);
    double predicted = 0;
    for (size_t i = 0; i < n; ++i) predicted += x[i] * now.side[i];
    if (predicted <= enough) return {p, now.chi_square, true};
    std::vector<double> q = p;
    for (size_t i = 0; i < n; ++i) q[i] += x[i];
    for (size_t g = 0; g < model.pulses; ++g) q[3 + 3 * g] = std::max(q[3 + 3 * g], least_width);
    const GaussianSum::Sums then = model.sums(q, signal, weight);
    if (then.chi_square <= now.chi_square) {
      const double fall = now.chi_square - then.chi_square;
      p = std::move(q), now = then, damping = std::max(damping / 10, 1e-12);
      if (fall <= enough) return {p, now.chi_square, true};
    } else if ((damping *= 10) > 1e8) {
      return {p, now.chi_square, true};  // no step improves
    }
  }
  return {p, now.chi_square, false};
}

}  // namespace suite
