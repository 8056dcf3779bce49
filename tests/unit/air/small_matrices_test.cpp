#include "air/small_matrices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace suite::small::small_matrices_test {
namespace {

using Matrix = std::vector<double>;

Matrix product(const Matrix& a, const Matrix& b, int n) {
  Matrix c(a.size(), 0.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) c[i * n + j] += a[i * n + k] * b[k * n + j];
  return c;
}

Matrix transposed(const Matrix& a, int n) {
  Matrix t(a.size());
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) t[j * n + i] = a[i * n + j];
  return t;
}

Matrix random_matrix(int n) {
  std::mt19937 generator(7 + n);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Matrix a(n * n);
  for (double& x : a) x = uniform(generator);
  return a;
}

double distance(const Matrix& a, const Matrix& b) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::fabs(a[i] - b[i]));
  return most;
}

class SmallMatrices : public testing::TestWithParam<int> {};

TEST_P(SmallMatrices, Products) {
  const int n = GetParam();
  const Matrix a = random_matrix(n), b = transposed(random_matrix(n), n);
  Matrix c(n * n), x(n, 0.5), y(n), z(n);
  multiply(a.data(), b.data(), c.data(), n);
  EXPECT_LT(distance(c, product(a, b, n)), 1e-14);
  const Matrix t = transposed(a, n);
  apply(t.data(), x.data(), y.data(), n);
  apply_transposed(a.data(), x.data(), z.data(), n);
  EXPECT_LT(distance(y, z), 1e-14);
  Matrix scaled = t;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) scaled[i * n + j] *= i + 1;
  std::vector<double> w;
  for (int i = 0; i < n; ++i) w.push_back(i + 1);
  weighted_square(a.data(), w.data(), c.data(), n);
  EXPECT_LT(distance(c, product(a, scaled, n)), 1e-12);
}

TEST_P(SmallMatrices, Factors) {
  const int n = GetParam();
  const Matrix a = random_matrix(n), right = random_matrix(n + 1);
  Matrix lu = a, x(right.begin(), right.begin() + n * n), b = x;
  int pivot[kMostRows];
  factor_lu(lu.data(), pivot, n);
  solve_lu(lu.data(), pivot, x.data(), n, n);
  EXPECT_LT(distance(product(a, x, n), b), 1e-10);
  Matrix positive = product(a, transposed(a, n), n);
  for (int i = 0; i < n; ++i) positive[i * n + i] += 0.1;
  Matrix factor = positive, y = b;
  ASSERT_TRUE(factor_cholesky(factor.data(), n));
  solve_lower(factor.data(), y.data(), n, n);
  solve_lower_transposed(factor.data(), y.data(), n, n);
  EXPECT_LT(distance(product(positive, y, n), b), 1e-10);
  positive[n * n - 1] = -1;
  EXPECT_FALSE(factor_cholesky(positive.data(), n));
}

TEST_P(SmallMatrices, Modes) {
  const int n = GetParam();
  Matrix a = random_matrix(n);
  const Matrix t = transposed(a, n);
  for (int i = 0; i < n * n; ++i) a[i] += t[i];
  for (const double coupling : {1.0, 1e-9, 0.0}) {  // 1e-9: entries that a sum of squares does not see
    Matrix symmetric = a;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        if (std::abs(i - j) > 1) symmetric[i * n + j] *= coupling;
    Matrix vectors = symmetric, values(n);
    ASSERT_TRUE(symmetric_modes(vectors.data(), values.data(), n));
    Matrix stretched = vectors;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) stretched[i * n + j] *= values[j];
    EXPECT_LT(distance(product(symmetric, vectors, n), stretched), 1e-13);
    Matrix one(n * n, 0.0);
    for (int i = 0; i < n; ++i) one[i * n + i] = 1;
    EXPECT_LT(distance(product(transposed(vectors, n), vectors, n), one), 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(Rows, SmallMatrices, testing::Values(2, 3, 4, 7, 8, 16, 31, 32));

TEST(SmallMatrices, SmallEigenvaluesOfGradedMatricesKeepTheirDigits) {
  // [[1, .5, .25], [.5, 1, .5], [.25, .5, 1]], of determinant 0.5625, between diag(1, 100, 1e4).
  double a[9] = {1, 50, 2500, 50, 1e4, 5e5, 2500, 5e5, 1e8}, values[3];
  ASSERT_TRUE(symmetric_modes(a, values, 3));
  EXPECT_NEAR(values[0] * values[1] * values[2] / 0.5625e12, 1, 1e-12);
}

}  // namespace
}  // namespace suite::small::small_matrices_test
