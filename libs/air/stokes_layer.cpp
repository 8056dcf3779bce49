#include "air/stokes_layer.h"

#include <algorithm>
#include <cmath>

#include "air/small_matrices.h"

namespace suite {

void StokesLayer::resize() {
  const auto cells = static_cast<size_t>(most_ * most_), rows = static_cast<size_t>(most_);
  for (auto* m : {&X_, &Y_, &XY_, &R_, &T_, &a_, &b_, &c_}) m->resize(cells);
  p_sum_.resize(rows), p_difference_.resize(rows), pivot_.resize(rows);
}

void StokesLayer::set(const double* X, const double* Y, int n, double depth, double steepest) {
  n_ = n, depth_ = depth;
  const int cells = n * n;
  std::copy(X, X + cells, X_.begin()), std::copy(Y, Y + cells, Y_.begin());
  small::multiply(X, Y, XY_.data(), n);
  int doublings = 0;
  double h = depth / 2;
  while (h * steepest > 1) h /= 2, ++doublings;
  half(X_.data(), Y_.data(), h, R_.data());
  half(Y_.data(), X_.data(), h, T_.data());
  for (int i = 0; i < cells; ++i) {
    const auto k = static_cast<size_t>(i);
    const double even = R_[k], odd = -T_[k];
    R_[k] = (even + odd) / 2, T_[k] = (even - odd) / 2;
  }
  for (; doublings > 0; --doublings) double_up();
}

void StokesLayer::half(const double* A, const double* B, double h, double* out) {
  const int n = n_, cells = n * n;
  double *const Z = a_.data(), *const Z2 = b_.data(), *const quotient = c_.data();
  small::multiply(B, A, Z, n);
  for (int i = 0; i < cells; ++i) Z[i] *= h * h;
  small::multiply(Z, Z, Z2, n);
  for (int i = 0; i < cells; ++i) {
    const double one = i % (n + 1) == 0 ? 945 : 0, z = Z[i], z2 = Z2[i];
    quotient[i] = one + 105 * z + z2;
    Z[i] = one + 420 * z + 15 * z2;
  }
  small::factor_lu(Z, pivot_.data(), n);
  small::solve_lu(Z, pivot_.data(), quotient, n, n);
  small::multiply(A, quotient, Z2, n);  // G / h
  for (int i = 0; i < cells; ++i) {
    const double one = i % (n + 1) == 0 ? 1 : 0, g = h * Z2[i];
    Z[i] = one + g, out[i] = one - g;
  }
  small::factor_lu(Z, pivot_.data(), n);
  small::solve_lu(Z, pivot_.data(), out, n, n);
}

void StokesLayer::double_up() {
  const int n = n_, cells = n * n;
  double *const E = a_.data(), *const ET = b_.data(), *const RET = c_.data();
  small::multiply(R_.data(), R_.data(), E, n);
  for (int i = 0; i < cells; ++i) E[i] = (i % (n + 1) == 0 ? 1 : 0) - E[i];
  small::factor_lu(E, pivot_.data(), n);
  std::copy(T_.begin(), T_.begin() + cells, ET);
  small::solve_lu(E, pivot_.data(), ET, n, n);
  small::multiply(R_.data(), ET, RET, n);
  small::multiply(T_.data(), RET, E, n);
  for (int i = 0; i < cells; ++i) R_[static_cast<size_t>(i)] += E[i];
  small::multiply(T_.data(), ET, E, n);
  std::copy(E, E + cells, T_.begin());
}

// Solutions that fall with the beam; false where one of the layer's own falls as it does.
bool StokesLayer::particular(double s, const double* sum, const double* difference) {
  const int n = n_;
  double* const M = a_.data();
  double *const S = p_sum_.data(), *const D = p_difference_.data();
  std::copy(XY_.begin(), XY_.begin() + n * n, M);
  for (int i = 0; i < n; ++i) M[i * n + i] -= s * s;
  small::apply(X_.data(), difference, D, n);
  double given = 0, found = 0;
  for (int i = 0; i < n; ++i) given = std::max(given, std::fabs(D[i] -= s * sum[i]));
  small::factor_lu(M, pivot_.data(), n);
  small::solve_lu(M, pivot_.data(), D, n, 1);
  small::apply(Y_.data(), D, S, n);
  for (int i = 0; i < n; ++i) {
    S[i] = (difference[i] - S[i]) / s;
    const double size = std::fabs(D[i]) + std::fabs(S[i]);
    found = size < HUGE_VAL ? std::max(found, size) : HUGE_VAL;  // of NaN as well
  }
  constexpr double kResonant = 1e8;
  return found <= kResonant * std::max(given, 1e-300);
}

void StokesLayer::respond(const double* q_up, const double* q_down, double secant, double* up, double* down) {
  const int n = n_;
  constexpr double kLeast = 1e-4, kAside = 1e-6;
  double s = std::fabs(secant) < kLeast ? std::copysign(kLeast, secant) : secant;
  double *const sum = b_.data(), *const difference = c_.data();
  for (int i = 0; i < n; ++i) sum[i] = q_up[i] + q_down[i], difference[i] = q_up[i] - q_down[i];
  for (int tries = 0; !particular(s, sum, difference) && tries < 4; ++tries) s *= 1 + kAside;
  const double left = std::exp(-s * depth_);
  double *const above = b_.data(), *const below = c_.data();  // what the solution brings into the layer
  for (int i = 0; i < n; ++i) {
    const double plus = (p_sum_[static_cast<size_t>(i)] + p_difference_[static_cast<size_t>(i)]) / 2,
                 minus = (p_sum_[static_cast<size_t>(i)] - p_difference_[static_cast<size_t>(i)]) / 2;
    above[i] = minus, below[i] = plus * left;
    up[i] = plus, down[i] = minus * left;
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double r = R_[static_cast<size_t>(i * n + j)], t = T_[static_cast<size_t>(i * n + j)];
      up[i] -= r * above[j] + t * below[j];
      down[i] -= r * below[j] + t * above[j];
    }
}

}  // namespace suite
