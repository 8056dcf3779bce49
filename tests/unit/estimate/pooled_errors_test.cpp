// Standard errors with the help of the problems beside: variances keep their mean, scatter less, and know of what the
// problem's own samples did not meet.
#include "estimate/pooled_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace suite::pooled_errors_test {
namespace {

constexpr uint32_t kSide = 64;
constexpr double kDegrees = 3;

struct Picture {
  explicit Picture(size_t n = 1) : values(n), errors(kSide * kSide * n) {}
  size_t values;
  std::vector<double> scatter = std::vector<double>(kSide * kSide, 1.0), around = std::vector<double>(kSide * kSide);
  std::vector<double> errors;
  double& at(size_t x, size_t y, size_t v = 0) { return errors[(y * kSide + x) * values + v]; }
  void pool() { pool_errors({kSide, values, 0, scatter, around}, kDegrees, errors); }
};

// Chi-square with three degrees of freedom over three.
double drawn(std::mt19937& random) {
  std::normal_distribution<double> normal;
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += std::pow(normal(random), 2);
  return sum / 3;
}

TEST(PooledErrors, VariancesKeepTheirMeanAndScatterLess) {
  Picture p(2);
  std::mt19937 random(1);
  for (size_t i = 0; i < p.scatter.size(); ++i) {
    const double square = drawn(random);
    p.scatter[i] = 4 * (0.7 + 0.6 * std::generate_canonical<double, 32>(random));
    p.errors[2 * i] = std::sqrt(square), p.errors[2 * i + 1] = 3 * std::sqrt(drawn(random));
  }
  double before = 0;
  for (size_t i = 0; i < p.scatter.size(); ++i) before += p.errors[2 * i] * p.errors[2 * i];
  p.pool();
  for (const size_t v : {0u, 1u}) {
    double mean = 0, square = 0;
    const double n = static_cast<double>(p.scatter.size()), scale = v ? 9 : 1;
    for (size_t i = 0; i < p.scatter.size(); ++i) {
      const double variance = std::pow(p.errors[2 * i + v], 2) / scale;
      mean += variance / n, square += variance * variance / n;
    }
    // Four standard errors of the mean of so many chi-squares: sqrt(2/3 / 4096) = 0.013.
    EXPECT_NEAR(mean, 1, 0.052) << v;
    // Of chi-square alone it is 2/3; of half of it and half of a mean of 24, 1/4 (2/3 + 2/3/24) and what S scatters.
    EXPECT_LT(square / (mean * mean) - 1, 0.25) << v;
    if (v == 0) {
      EXPECT_NEAR(mean, before / n, 0.02);
    }
  }
}

TEST(PooledErrors, SmoothBesideAnEdgeStaysSmooth) {
  Picture p;
  for (size_t y = 0; y < kSide; ++y)
    for (size_t x = 0; x < kSide; ++x) {
      const bool edge = x == 30;
      p.scatter[y * kSide + x] = edge ? 1 : 1e-6;
      p.at(x, y) = edge ? (y % 2 ? 0.0 : 0.2) : 1e-4;
    }
  p.pool();
  for (size_t y = 2; y < kSide - 2; ++y) {
    EXPECT_LT(p.at(29, y), 6e-4) << "E 1e-4; 20 octaves away";
    // Every second one's scrambles agreed by chance: half of the mean of the squares of all.
    EXPECT_NEAR(p.at(30, y), y % 2 ? 0.1 : std::sqrt((0.04 + 0.02) / 2), 0.03);
  }
}

TEST(PooledErrors, WhatWasNotMetIsKnownFromAround) {
  Picture p(2);
  for (size_t i = 0; i < p.scatter.size(); ++i) {
    const bool met = i % 3 != 0;
    p.scatter[i] = met ? 0.01 : 0;
    p.errors[2 * i] = met ? 0.05 : 0, p.errors[2 * i + 1] = met ? 0.10 : 0;
    p.around[i] = 0.04;
  }
  const Picture before = p;
  p.pool();
  for (size_t y = 2; y < kSide - 2; ++y)
    for (size_t x = 2; x < kSide - 2; ++x)
      if ((y * kSide + x) % 3 == 0) {
        EXPECT_NEAR(p.at(x, y, 0), 0.04 / std::sqrt(2), 1e-12);
        EXPECT_NEAR(p.at(x, y, 1), 0.08 / std::sqrt(2), 1e-12) << "twice the noise of the other value all around";
      }
  // Negative control: without it nothing is known.
  Picture blind = before;
  std::fill(blind.around.begin(), blind.around.end(), 0.0);
  blind.pool();
  EXPECT_EQ(blind.at(3, 0, 0), 0);
}

// Found in arrays whose reference band has no light: intervals of the others held 88 % instead of 95 %.
TEST(PooledErrors, WithoutScatterAtTheReferenceOtherValuesArePooled) {
  Picture p(2);
  std::mt19937 random(2);
  for (size_t i = 0; i < p.scatter.size(); ++i) p.scatter[i] = 0, p.errors[2 * i + 1] = std::sqrt(drawn(random));
  p.at(40, 40, 0) = p.at(40, 40, 1) = INFINITY;
  p.pool();
  double mean = 0, square = 0, n = 0;
  for (size_t i = 0; i < p.scatter.size(); ++i) {
    if (!std::isfinite(p.errors[2 * i])) continue;
    EXPECT_EQ(p.errors[2 * i], 0);
    const double variance = p.errors[2 * i + 1] * p.errors[2 * i + 1];
    mean += variance, square += variance * variance, ++n;
  }
  mean /= n, square /= n;
  EXPECT_NEAR(mean, 1, 0.052);
  EXPECT_LT(square / (mean * mean) - 1, 0.25) << "chi-square alone: 2/3";
}

TEST(PooledErrors, WhatIsNotFiniteStaysAndTellsNothing) {
  Picture p;
  for (size_t i = 0; i < p.scatter.size(); ++i) p.errors[i] = 1;
  p.at(5, 5) = INFINITY;
  p.pool();
  EXPECT_EQ(p.at(5, 5), INFINITY);
  EXPECT_NEAR(p.at(6, 5), 1, 0.03);
  EXPECT_LT(p.at(6, 5), 1);
  EXPECT_NEAR(p.at(40, 40), 1, 1e-12);
}

// Two octaves of S apart count 1 / (1 + 2^2) of one that is alike: with S = 1, 4, 1 and E^2 = 1, 8, 1 the first expects
// r S = (8 / 5 + 1) / (4 / 5 + 1).
TEST(PooledErrors, OctavesApartCountLess) {
  std::vector<double> errors{1, std::sqrt(8), 1}, scatter{1, 4, 1}, none(3, 0.0);
  pool_errors({3, 1, 0, scatter, none}, kDegrees, errors);
  EXPECT_NEAR(errors[0] * errors[0], (1 + 2.6 / 1.8) / 2, 1e-12);
}

TEST(PooledErrors, OneProblemAndOneRow) {
  std::vector<double> error{0.5}, scatter{1}, around{0};
  pool_errors({1, 1, 0, scatter, around}, kDegrees, error);
  EXPECT_EQ(error[0], 0.5);
  std::vector<double> row(7, 0.5), scatters(7, 1.0), none(7, 0.0);
  pool_errors({7, 1, 0, scatters, none}, kDegrees, row);
  for (const double e : row) EXPECT_NEAR(e, 0.5, 1e-12);
}

}  // namespace
}  // namespace suite::pooled_errors_test
