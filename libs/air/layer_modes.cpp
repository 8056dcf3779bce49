#include "air/layer_modes.h"

#include <algorithm>
#include <cmath>

#include "air/small_matrices.h"

namespace suite::ordinates {

using namespace small;

namespace {

constexpr int kCells = kMostRows * kMostRows;

// x becomes (1 + x)^-1 x, for x symmetric and not negative.
void saturate(double* x, int n) {
  double factor[kCells];
  std::copy(x, x + n * n, factor);
  for (int i = 0; i < n; ++i) factor[i * n + i] += 1;
  factor_cholesky(factor, n);
  solve_lower(factor, x, n, n);
  solve_lower_transposed(factor, x, n, n);
}

// sinh(k y) / sinh(k T) for k T < 0.5, to rounding.
double low_shape(double k, double y, double depth) {
  const auto series = [](double z2) {
    return 1 + z2 / 6 * (1 + z2 / 20 * (1 + z2 / 42 * (1 + z2 / 72 * (1 + z2 / 110))));
  };
  return y / depth * series(k * k * y * y) / series(k * k * depth * depth);
}

// Gauss's rule with 6 points on [0, 1] (Abramowitz & Stegun 1964, table 25.4).
constexpr double kNode[6] = {0.03376524289842399, 0.16939530676686774, 0.38069040695840155,
                             0.61930959304159845, 0.83060469323313226, 0.96623475710157601};
constexpr double kWeight[6] = {0.08566224618958517, 0.18038078652406930, 0.23395696728634552,
                               0.23395696728634552, 0.18038078652406930, 0.08566224618958517};

}  // namespace

bool find_modes(double* a, double* b, bool conservative, const ModesOf<double>& modes, int n) {
  double product[kCells], c[kCells];
  if (!factor_cholesky(a, n)) return false;
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j) a[i * n + j] = 0;
  multiply(b, a, product, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) modes.D[i * n + j] = a[j * n + i];
  multiply(modes.D, product, c, n);
  std::copy(c, c + n * n, modes.D);
  if (!symmetric_modes(modes.D, modes.k, n)) return false;
  multiply(a, modes.D, modes.S, n);
  solve_lower_transposed(a, modes.D, n, n);
  // The smallest eigenvalue once more as a Rayleigh quotient: its error is then that of B's row sums.
  const int least = static_cast<int>(std::min_element(modes.k, modes.k + n) - modes.k);
  double column[kMostRows], image[kMostRows], quotient = 0;
  for (int i = 0; i < n; ++i) column[i] = modes.S[i * n + least];
  apply(b, column, image, n);
  for (int i = 0; i < n; ++i) quotient += column[i] * image[i];
  modes.k[least] = conservative ? 0 : quotient;
  for (int j = 0; j < n; ++j) {
    if (!(modes.k[j] > -1e-8)) return false;
    modes.k[j] = std::sqrt(std::max(0.0, modes.k[j]));
  }
  return true;
}

void layer_response(const Modes& modes, double depth, double* reflection, double* transmission, int n) {
  double even[kMostRows] = {}, odd[kMostRows] = {}, g[kCells], h[kCells];
  for (int j = 0; j < n; ++j) {
    const double k = modes.k[j], half = std::tanh(k * depth / 2);
    even[j] = k * half;
    odd[j] = k * depth > 1e-8 ? half / k : depth / 2;
  }
  weighted_square(modes.D, even, g, n);
  weighted_square(modes.S, odd, h, n);
  saturate(g, n);
  saturate(h, n);
  // reflection + transmission = (1 - G) / (1 + G), reflection - transmission = (H - 1) / (H + 1).
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int ij = i * n + j;
      reflection[ij] = h[ij] - g[ij];
      transmission[ij] = (i == j) - (h[ij] + g[ij]);
    }
}

double decay_integral(double a, double depth) {
  const double x = a * depth;
  return std::fabs(x) < 1e-10 ? depth * (1 - x / 2) : -std::expm1(-x) / a;
}

EndIntegrals beam_integrals(double k, double secant, double depth) {
  const double x = k * depth, y = secant * depth;
  EndIntegrals result;
  if (x >= 0.5) {
    const double own = std::exp(-x), scale = 1 / (-std::expm1(-2 * x));
    const double falling = decay_integral(k + secant, depth),
                 mixed = std::exp(-std::min(x, y)) * decay_integral(std::fabs(k - secant), depth);
    result = {(falling - own * mixed) * scale, (mixed - own * falling) * scale};
  } else if (std::fabs(y) <= 1) {
    for (int i = 0; i < 6; ++i) {
      const double f = kWeight[i] * depth * std::exp(-kNode[i] * y);
      result.top += f * low_shape(k, (1 - kNode[i]) * depth, depth);
      result.bottom += f * low_shape(k, kNode[i] * depth, depth);
    }
  } else {
    const double same = x > 1e-8 ? k / std::tanh(x) : 1 / depth, other = x > 1e-8 ? k / std::sinh(x) : 1 / depth;
    const double through = std::exp(-y), scale = 1 / (secant * secant - k * k);
    result = {(secant - same + other * through) * scale, (other - through * (secant + same)) * scale};
  }
  return result;
}

EndIntegrals linear_integrals(double k, double depth) {
  const double x = k * depth, x2 = x * x;
  const double whole = x > 1e-8 ? std::tanh(x / 2) / k : depth / 2;
  double far;
  if (x < 0.1) {
    far = depth * (1.0 / 6 - x2 * (7.0 / 360 - x2 * (31.0 / 15120 - x2 * 127.0 / 604800)));
  } else {
    far = (1 - (x < 700 ? x / std::sinh(x) : 0)) * depth / x2;
  }
  return {whole - far, far};
}

EndIntegrals emission_integrals(double y) {
  if (y < 0.01) {
    const double far = y * (1.0 / 2 - y * (1.0 / 3 - y * (1.0 / 8 - y * (1.0 / 30 - y / 144))));
    return {-std::expm1(-y) - far, far};
  }
  const double mean = -std::expm1(-y) / y, through = std::exp(-y);
  return {1 - mean, mean - through};
}

}  // namespace suite::ordinates
