// Running statistics against long double sums, distribution functions against published tables.
#include <gtest/gtest.h>

#include <vector>

#include "math/sampling.h"
#include "math/stats.h"

namespace suite::stats_test {

TEST(RunningStats, AgreesWithTheTwoPassFormulaAndMerges) {
  Pcg32 rng(5);
  std::vector<double> x(1001);
  for (double& v : x) v = 1e9 + rng.uniform();  // a naive sum of squares would lose everything here
  long double mean = 0, m2 = 0;
  for (const double v : x) mean += v;
  mean /= static_cast<long double>(x.size());
  for (const double v : x) m2 += (v - mean) * (v - mean);
  const double variance = static_cast<double>(m2 / (static_cast<long double>(x.size()) - 1));
  RunningStats all, left, right;
  for (size_t i = 0; i < x.size(); ++i) {
    all.add(x[i]);
    (i < 300 ? left : right).add(x[i]);
  }
  left.merge(right);
  left.merge(RunningStats());
  for (const RunningStats& s : {all, left}) {
    EXPECT_EQ(s.n(), x.size());
    EXPECT_NEAR(s.mean(), static_cast<double>(mean), 1e-6);
    EXPECT_NEAR(s.variance(), variance, 1e-6 * variance);
    EXPECT_NEAR(s.stderr_of_mean(), std::sqrt(variance / 1001), 1e-6);
  }
}

TEST(RunningStats, FewSamples) {
  RunningStats s;
  EXPECT_EQ(s.mean(), 0);
  EXPECT_EQ(s.variance(), 0);
  s.add(3);
  EXPECT_EQ(s.mean(), 3);
  EXPECT_EQ(s.variance(), 0);
  EXPECT_EQ(s.estimate().stderr_, 0);
  RunningStats empty;
  empty.merge(s);
  EXPECT_EQ(empty.mean(), 3);
}

TEST(RunningStats, AHundredMillionEqualSamplesStayExact) {
  // A float accumulator turns 0.5 into 1.0 here.
  RunningStats part, whole;
  for (int i = 0; i < 1000000; ++i) part.add(0.5);
  for (int i = 0; i < 100; ++i) whole.merge(part);
  EXPECT_EQ(whole.n(), 100000000u);
  EXPECT_EQ(whole.mean(), 0.5);
  EXPECT_EQ(whole.variance(), 0);
}

TEST(Distributions, StudentQuantilesMatchTheTable) {
  // Two-sided critical values to all printed digits, e.g. Abramowitz & Stegun, table 26.10.
  const struct {
    double confidence;
    int n;
    double t;
  } table[] = {{0.95, 1, 12.706}, {0.95, 2, 4.303},  {0.95, 3, 3.182},   {0.95, 4, 2.776},  {0.95, 7, 2.365},
               {0.95, 10, 2.228}, {0.95, 30, 2.042}, {0.95, 120, 1.980}, {0.99, 1, 63.657}, {0.99, 5, 4.032},
               {0.99, 20, 2.845}, {0.90, 3, 2.353},  {0.50, 1, 1.000}};
  for (const auto& row : table)
    EXPECT_NEAR(student_t_quantile(row.confidence, row.n), row.t, 0.00051) << row.confidence << " " << row.n;
}

// Two-sided quantiles of 0.95: 1.9623391 of 1000 degrees (summed term by term), 1.9599640 of a normal variable; between
// them they fall as 2.37 / n (the first term of Abramowitz & Stegun 26.7.5).
TEST(Distributions, StudentQuantilesOfManyDegrees) {
  EXPECT_NEAR(student_t_quantile(0.95, 1000), 1.9623391, 1e-6);
  EXPECT_NEAR(student_t_quantile(0.95, 1001), 1.9623391 - 2.37e-6, 2e-6);
  EXPECT_NEAR(student_t_quantile(0.95, 1 << 30), 1.9599640, 1e-6);
}

TEST(Distributions, ChiSquareTailsMatchTheTable) {
  // Upper 5 % and 1 % points, Abramowitz & Stegun, table 26.8.
  const struct {
    double p, k, x;
  } table[] = {{0.05, 1, 3.841459},     {0.05, 2, 5.991465},  {0.05, 10, 18.307038}, {0.05, 100, 124.342113},
               {0.01, 1, 6.634897},     {0.01, 5, 15.086272}, {0.01, 30, 50.892181}, {0.99, 10, 2.558212},
               {0.995, 100, 67.327563}, {0.001, 1, 10.827566}};
  for (const auto& row : table)
    EXPECT_NEAR(chi_square_tail(row.x, row.k), row.p, 1e-7 + 1e-6 * row.p) << row.k << " " << row.x;
}

TEST(Distributions, FarTailsKeepRelativeDigits) {
  // For k = 2 the tail is exp(-x/2) in closed form: tests at significance 1e-20 need digits there, not only 0.
  for (const double x : {1.0, 10.0, 50.0, 100.0, 400.0, 1000.0})
    EXPECT_NEAR(chi_square_tail(x, 2) / std::exp(-x / 2), 1, 1e-10) << x;
  EXPECT_EQ(chi_square_tail(0, 3), 1);
  EXPECT_NEAR(chi_square_tail(1e-12, 2), 1, 1e-12);
  EXPECT_NEAR(gamma_p(0.5, 0.25), std::erf(0.5), 1e-14);
  EXPECT_NEAR(gamma_p(3, 2), 1 - std::exp(-2.0) * (1 + 2 + 2), 1e-14);
  EXPECT_NEAR(chi_square_tail(10000, 10000), 0.49812, 2e-5);  // Wilson-Hilferty to its own accuracy
}

TEST(Distributions, NormalTails) {
  EXPECT_NEAR(normal_two_sided(1.959963984540054), 0.05, 1e-12);
  EXPECT_NEAR(normal_two_sided(-2.575829303548901), 0.01, 1e-12);
  EXPECT_EQ(normal_two_sided(0), 1);
}

TEST(ChiSquareTest, PoolsRareCellsAndRejectsTheImpossible) {
  int degrees = 0;
  EXPECT_NEAR(chi_square_test(std::vector<double>{10, 20, 30}, std::vector<double>{10, 20, 30}, 5, &degrees), 1, 1e-12);
  EXPECT_EQ(degrees, 2);
  chi_square_test(std::vector<double>{1, 0, 2, 1, 50}, std::vector<double>{1, 1, 1, 1, 50}, 4, &degrees);
  EXPECT_EQ(degrees, 1);
  EXPECT_EQ(chi_square_test(std::vector<double>{1, 50}, std::vector<double>{0, 51}, 5, &degrees), 0);
  EXPECT_EQ(degrees, 0);
  EXPECT_EQ(chi_square_test(std::vector<double>{0, 50}, std::vector<double>{0, 50}, 5, &degrees), 1);
  // (45-50)^2/50 + (55-50)^2/50 = 1 with one degree of freedom.
  EXPECT_NEAR(chi_square_test(std::vector<double>{45, 55}, std::vector<double>{50, 50}, 5), 0.31731050786291, 1e-10);
}

}  // namespace suite::stats_test
