#include "math/anderson.h"

#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

using Vector = std::vector<double>;

double dot(const Vector& a, const Vector& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

Anderson::Anderson(Vector weights, size_t memory) : weights_(std::move(weights)), memory_(memory) {}

Vector Anderson::next(const Vector& x, const Vector& g) {
  SUITE_CHECK(x.size() == weights_.size() && g.size() == weights_.size());
  if (memory_ == 0) return g;
  Vector f(x.size());
  for (size_t i = 0; i < x.size(); ++i) f[i] = weights_[i] * (g[i] - x[i]);
  if (!last_f_.empty()) {
    Vector df(x.size()), dg(x.size());
    for (size_t i = 0; i < x.size(); ++i) df[i] = f[i] - last_f_[i], dg[i] = g[i] - last_g_[i];
    df_.push_front(std::move(df));
    dg_.push_front(std::move(dg));
    if (df_.size() > memory_) df_.pop_back(), dg_.pop_back();
  }
  last_f_ = f;
  last_g_ = g;
  // Least squares by modified Gram-Schmidt, newest differences first; nearly dependent ones are left out. What is
  // done to df is done to dg, so no triangular system needs solving.
  Vector result = g;
  std::vector<Vector> q, r;
  for (size_t k = 0; k < df_.size(); ++k) {
    Vector a = df_[k], b = dg_[k];
    const double size = std::sqrt(dot(a, a));
    for (size_t m = 0; m < q.size(); ++m) {
      const double c = dot(q[m], a);
      for (size_t i = 0; i < a.size(); ++i) a[i] -= c * q[m][i], b[i] -= c * r[m][i];
    }
    const double rest = std::sqrt(dot(a, a));
    if (!(rest > 1e-6 * size)) continue;
    for (size_t i = 0; i < a.size(); ++i) a[i] /= rest, b[i] /= rest;
    const double c = dot(a, f);
    for (size_t i = 0; i < a.size(); ++i) f[i] -= c * a[i], result[i] -= c * b[i];
    q.push_back(std::move(a));
    r.push_back(std::move(b));
  }
  return result;
}

}  // namespace suite
