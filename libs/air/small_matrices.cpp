#include "air/small_matrices.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace suite::small {

namespace {

// Four numbers of a row in one register; a row's sums stay in registers when their number is known while compiling.
typedef double Pack __attribute__((vector_size(32)));

template <int N>
void multiply_fixed(const double* a, const double* b, double* product) {
  constexpr int packs = N / 4;
  for (int i = 0; i < N; ++i) {
    Pack row[packs] = {};
    for (int k = 0; k < N; ++k) {
      const double f = a[i * N + k];
      for (int j = 0; j < packs; ++j) {
        Pack right;
        std::memcpy(&right, b + k * N + 4 * j, sizeof(right));
        row[j] += f * right;
      }
    }
    std::memcpy(product + i * N, row, sizeof(row));
  }
}

void multiply_any(const double* a, const double* b, double* product, int n) {
  for (int i = 0; i < n; ++i) {
    double row[kMostRows];
    std::fill_n(row, n, 0.0);
    for (int k = 0; k < n; ++k) {
      const double f = a[i * n + k];
      for (int j = 0; j < n; ++j) row[j] += f * b[k * n + j];
    }
    std::copy(row, row + n, product + i * n);
  }
}

// a = Q T Q^T: T's diagonal and the entries below it (off[0] unused), Q in the place of a.
void tridiagonalise(double* a, double* diagonal, double* off, int n) {
  for (int i = n - 1; i > 0; --i) {
    double* row = a + i * n;
    double h = 0;
    for (int k = 0; k < i - 1; ++k) h += row[k] * row[k];
    if (h == 0) {  // nothing to clear
      off[i] = row[i - 1];
      diagonal[i] = 0;
      continue;
    }
    h += row[i - 1] * row[i - 1];
    const double f = row[i - 1], g = f >= 0 ? -std::sqrt(h) : std::sqrt(h);
    off[i] = g;
    h -= f * g;
    row[i - 1] = f - g;
    double inner = 0;
    for (int j = 0; j < i; ++j) {
      a[j * n + i] = row[j] / h;
      double sum = 0;
      for (int k = 0; k <= j; ++k) sum += a[j * n + k] * row[k];
      for (int k = j + 1; k < i; ++k) sum += a[k * n + j] * row[k];
      off[j] = sum / h;
      inner += off[j] * row[j];
    }
    const double half = inner / (h + h);
    for (int j = 0; j < i; ++j) {
      const double u = row[j], v = off[j] -= half * u;
      for (int k = 0; k <= j; ++k) a[j * n + k] -= u * off[k] + v * row[k];
    }
    diagonal[i] = h;
  }
  off[0] = diagonal[0] = 0;
  for (int i = 0; i < n; ++i) {
    if (diagonal[i] != 0) {
      double product[kMostRows] = {};
      for (int k = 0; k < i; ++k)
        for (int j = 0; j < i; ++j) product[j] += a[i * n + k] * a[k * n + j];
      for (int k = 0; k < i; ++k)
        for (int j = 0; j < i; ++j) a[k * n + j] -= product[j] * a[k * n + i];
    }
    diagonal[i] = a[i * n + i];
    a[i * n + i] = 1;
    for (int j = 0; j < i; ++j) a[j * n + i] = a[i * n + j] = 0;
  }
}

// One implicit QL step on rows from..to of the tridiagonal matrix; rotates the columns of z.
void ql_step(double* z, double* d, double* e, int from, int to, int n) {
  double g = (d[from + 1] - d[from]) / (2 * e[from]);
  const double root = std::hypot(g, 1.0);
  g = d[to] - d[from] + e[from] / (g + std::copysign(root, g));
  double sine = 1, cosine = 1, p = 0;
  for (int i = to - 1; i >= from; --i) {
    const double f = sine * e[i], b = cosine * e[i], r = std::sqrt(f * f + g * g);
    e[i + 1] = r;
    if (r == 0) {
      d[i + 1] -= p;
      e[to] = 0;
      return;
    }
    sine = f / r;
    cosine = g / r;
    g = d[i + 1] - p;
    const double t = (d[i] - g) * sine + 2 * cosine * b;
    p = sine * t;
    d[i + 1] = g + p;
    g = cosine * t - b;
    for (int k = 0; k < n; ++k) {
      const double right = z[(i + 1) * n + k], left = z[i * n + k];
      z[(i + 1) * n + k] = sine * left + cosine * right;
      z[i * n + k] = cosine * left - sine * right;
    }
  }
  d[from] -= p;
  e[from] = g;
  e[to] = 0;
}

void transpose(double* a, int n) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) std::swap(a[i * n + j], a[j * n + i]);
}

}  // namespace

void multiply(const double* a, const double* b, double* product, int n) {
  switch (n) {
    case 4:
      return multiply_fixed<4>(a, b, product);
    case 8:
      return multiply_fixed<8>(a, b, product);
    case 16:
      return multiply_fixed<16>(a, b, product);
    default:
      return multiply_any(a, b, product, n);
  }
}

void apply(const double* a, const double* x, double* y, int n) {
  for (int i = 0; i < n; ++i) {
    double sum = 0;
    for (int j = 0; j < n; ++j) sum += a[i * n + j] * x[j];
    y[i] = sum;
  }
}

void apply_transposed(const double* a, const double* x, double* y, int n) {
  std::fill(y, y + n, 0.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) y[j] += a[i * n + j] * x[i];
}

void weighted_square(const double* a, const double* w, double* sum, int n) {
  double scaled[kMostRows * kMostRows], transposed[kMostRows * kMostRows];
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      scaled[i * n + j] = a[i * n + j] * w[j];
      transposed[j * n + i] = a[i * n + j];
    }
  multiply(scaled, transposed, sum, n);
}

bool factor_cholesky(double* a, int n) {
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (int k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      if (i != j) {
        a[i * n + j] = sum / a[j * n + j];
      } else if (sum > 0) {
        a[i * n + i] = std::sqrt(sum);
      } else {
        return false;
      }
    }
  }
  return true;
}

void solve_lower(const double* factor, double* x, int n, int columns) {
  for (int i = 0; i < n; ++i) {
    double* row = x + i * columns;
    for (int k = 0; k < i; ++k) {
      const double f = factor[i * n + k];
      for (int j = 0; j < columns; ++j) row[j] -= f * x[k * columns + j];
    }
    const double inverse = 1 / factor[i * n + i];
    for (int j = 0; j < columns; ++j) row[j] *= inverse;
  }
}

void solve_lower_transposed(const double* factor, double* x, int n, int columns) {
  for (int i = n - 1; i >= 0; --i) {
    double* row = x + i * columns;
    for (int k = i + 1; k < n; ++k) {
      const double f = factor[k * n + i];
      for (int j = 0; j < columns; ++j) row[j] -= f * x[k * columns + j];
    }
    const double inverse = 1 / factor[i * n + i];
    for (int j = 0; j < columns; ++j) row[j] *= inverse;
  }
}

void factor_lu(double* a, int* pivot, int n) {
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k + 1; i < n; ++i)
      if (std::fabs(a[i * n + k]) > std::fabs(a[best * n + k])) best = i;
    pivot[k] = best;
    if (best != k) std::swap_ranges(a + k * n, a + k * n + n, a + best * n);
    const double inverse = 1 / a[k * n + k];
    for (int i = k + 1; i < n; ++i) {
      const double f = a[i * n + k] *= inverse;
      for (int j = k + 1; j < n; ++j) a[i * n + j] -= f * a[k * n + j];
    }
  }
}

void solve_lu(const double* factor, const int* pivot, double* x, int n, int columns) {
  for (int k = 0; k < n; ++k)
    if (pivot[k] != k) std::swap_ranges(x + k * columns, x + (k + 1) * columns, x + pivot[k] * columns);
  for (int i = 1; i < n; ++i)
    for (int k = 0; k < i; ++k) {
      const double f = factor[i * n + k];
      for (int j = 0; j < columns; ++j) x[i * columns + j] -= f * x[k * columns + j];
    }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) {
      const double f = factor[i * n + k];
      for (int j = 0; j < columns; ++j) x[i * columns + j] -= f * x[k * columns + j];
    }
    const double inverse = 1 / factor[i * n + i];
    for (int j = 0; j < columns; ++j) x[i * columns + j] *= inverse;
  }
}

bool symmetric_modes(double* a, double* values, int n) {
  double off[kMostRows];
  tridiagonalise(a, values, off, n);
  transpose(a, n);  // eigenvectors as rows while they are rotated
  for (int i = 1; i < n; ++i) off[i - 1] = off[i];
  off[n - 1] = 0;
  for (int from = 0; from < n; ++from) {
    for (int step = 0;; ++step) {
      int to = from;
      while (to < n - 1) {
        const double size = std::fabs(values[to]) + std::fabs(values[to + 1]);
        if (std::fabs(off[to]) <= 1.1e-16 * size) break;
        ++to;
      }
      if (to == from) break;
      if (step == 60) return false;
      ql_step(a, values, off, from, to, n);
    }
  }
  transpose(a, n);
  return true;
}

}  // namespace suite::small
