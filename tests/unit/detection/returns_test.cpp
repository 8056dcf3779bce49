// Walk of discriminators and errors of decompositions against closed forms.
#include "detection/returns.h"

#include <gtest/gtest.h>

#include <cmath>

#include "detection/decompose.h"
#include "detection/variates.h"
#include "math/stats.h"
#include "math/variates.h"
#include "spectral/planck.h"

namespace suite::returns_test {
namespace {

constexpr double kNs = 1e-9;

// Gaussians {amplitude, centre (s), deviation (s)} at the middles of samples.
std::vector<double> gaussians(const SampleGrid& grid, const std::vector<std::array<double, 3>>& pulses,
                              double base = 0) {
  std::vector<double> v(grid.count, base);
  for (size_t k = 0; k < grid.count; ++k)
    for (const auto& p : pulses) v[k] += p[0] * std::exp(-0.5 * std::pow((grid.middle(k) - p[1]) / p[2], 2));
  return v;
}

// -sigma sqrt(2 ln(A / level)): sigma 0.5 ns, -1.0730 ns at ten times the threshold, -0.5887 ns at twice.
TEST(Returns, WalkOfAThreshold) {
  const SampleGrid grid = samples_within(0, 20 * kNs, 0.004 * kNs);
  for (const auto& [ratio, walk] : {std::pair{10.0, -1.072983}, std::pair{2.0, -0.588705}}) {
    const auto found = leading_edges(gaussians(grid, {{ratio, 10 * kNs, 0.5 * kNs}}), grid, {1, 0, 0, 9});
    ASSERT_EQ(found.size(), size_t{1});
    EXPECT_NEAR(found[0].time / kNs - 10, walk, 2e-5);
    EXPECT_NEAR(found[0].amplitude, ratio, 1e-3 * ratio);
  }
}

// delay / 2 - sigma^2 ln(1 / fraction) / delay = 0.183392 ns for 0.5 ns, 0.8 ns, 0.5, whatever the amplitude.
TEST(Returns, ConstantFractionHasNoWalk) {
  const SampleGrid grid = samples_within(0, 20 * kNs, 0.01 * kNs);
  for (const double amplitude : {1.2, 12.0, 1200.0}) {
    const auto found =
        constant_fractions(gaussians(grid, {{amplitude, 10 * kNs, 0.5 * kNs}}), grid, {{1, 0, 0, 9}, 0.5, 0.8 * kNs});
    ASSERT_EQ(found.size(), size_t{1}) << amplitude;
    EXPECT_NEAR(found[0].time / kNs - 10, 0.183392, 2e-5) << amplitude;
  }
  EXPECT_TRUE(
      constant_fractions(gaussians(grid, {{0.9, 10 * kNs, 0.5 * kNs}}), grid, {{1, 0, 0, 9}, 0.5, 0.8 * kNs}).empty());
}

TEST(Returns, SeveralReturnsHysteresisAndDeadTime) {
  const SampleGrid grid = samples_within(0, 60 * kNs, 0.05 * kNs);
  const auto v = gaussians(grid, {{5, 10 * kNs, kNs}, {3, 20 * kNs, kNs}, {4, 40 * kNs, kNs}}, 0.5);
  const auto all = leading_edges(v, grid, {1, 0, 0, 9});
  ASSERT_EQ(all.size(), size_t{3});
  EXPECT_EQ(all[2].number, 3u);
  EXPECT_EQ(all[0].of, 3u);
  EXPECT_EQ(leading_edges(v, grid, {1, 0, 15 * kNs, 9}).size(), size_t{2});  // deaf to the second
  EXPECT_EQ(leading_edges(v, grid, {1, 0.6, 0, 9}).size(), size_t{1});       // never below 0.4 again
  EXPECT_EQ(leading_edges(v, grid, {1, 0, 0, 2}).size(), size_t{2});
}

// Two equal Gaussians have two maxima only beyond two deviations; shoulders are found nearer than that.
TEST(Decompose, MaximaAndShoulders) {
  const SampleGrid grid = samples_within(0, 60 * kNs, 0.5 * kNs);
  for (const double apart : {1.7, 2.5, 6.0}) {
    const auto v = gaussians(grid, {{100, 20 * kNs, 2 * kNs}, {80, (20 + 2 * apart) * kNs, 2 * kNs}}, 10);
    size_t maxima = 0;
    for (size_t k = 1; k + 1 < v.size(); ++k) maxima += v[k] > v[k - 1] && v[k] >= v[k + 1];
    EXPECT_EQ(maxima, apart > 2 ? size_t{2} : size_t{1}) << apart;
    const double noise[] = {1};
    const Decomposition d = decompose(v, noise, grid, {1.8 * kNs, 5, 8, 200});
    ASSERT_EQ(d.pulses.size(), size_t{2}) << apart;
    EXPECT_NEAR(d.pulses[0].centre / kNs, 20, 1e-3);
    EXPECT_NEAR(d.pulses[1].centre / kNs, 20 + 2 * apart, 1e-3);
    EXPECT_NEAR(d.pulses[0].amplitude, 100, 0.05);
    EXPECT_NEAR(d.pulses[1].width / kNs, 2, 1e-3);
    EXPECT_NEAR(d.baseline, 10, 1e-3);
  }
  // Nearer than half a FWHM they are one.
  const double noise[] = {1};
  EXPECT_EQ(decompose(gaussians(grid, {{100, 20 * kNs, 2 * kNs}, {80, 21 * kNs, 2 * kNs}}), noise, grid,
                      {1.8 * kNs, 5, 8, 200})
                .pulses.size(),
            size_t{1});
}

// White noise s in samples dt apart: var(centre) = 2 s^2 sigma dt / (A^2 sqrt(pi)), the inverse of Fisher's
// information.
TEST(Decompose, CovarianceIsWhatRunsScatterBy) {
  const SampleGrid grid = samples_within(0, 40 * kNs, kNs);
  const double noise[] = {2}, sigma = 2 * kNs;
  const double expected = std::sqrt(2 * 4 * sigma * kNs / (50 * 50 * std::sqrt(3.14159265358979323846)));
  RunningStats centre, told;
  for (uint64_t run = 0; run < 500; ++run) {
    Pcg32 random = stream_of(7, 0, run);
    std::vector<double> v = gaussians(grid, {{50, 20.3 * kNs, sigma}}, 5);
    for (double& x : v) x += 2 * normal(random);
    const Decomposition d = decompose(v, noise, grid, {sigma / 2, 15, 4, 100});
    ASSERT_EQ(d.pulses.size(), size_t{1}) << run;
    centre.add(d.pulses[0].centre), told.add(std::sqrt(d.pulses[0].covariance[4]));
  }
  EXPECT_NEAR(told.mean(), expected, 0.01 * expected);
  const double scatter = std::sqrt(centre.variance()), error = scatter / std::sqrt(2.0 * 500);
  EXPECT_NEAR(scatter, expected, 4 * error);
  EXPECT_GT(std::fabs(scatter - 1.2 * expected), 4 * error);  // negative control
  EXPECT_NEAR(centre.mean(), 20.3 * kNs, 4 * centre.stderr_of_mean());
}

// EM never makes the likelihood fall, and N photons time a pulse to sigma / sqrt(N): 6.366 mm of range for a FWHM of
// 1 ns and 100 photons.
TEST(Decompose, PhotonsByExpectationAndMaximisation) {
  const SampleGrid grid = samples_within(0, 8 * kNs, 0.1 * kNs);
  const double sigma = kNs / kFwhmOfDeviation;
  RunningStats centre, told;
  std::vector<double> course;
  for (uint64_t run = 0; run < 400; ++run) {
    Pcg32 random = stream_of(8, 0, run);
    std::vector<double> counts =
        gaussians(grid, {{100 * 0.1 * kNs / (sigma * std::sqrt(2 * 3.14159265358979323846)), 4 * kNs, sigma}});
    for (double& x : counts) x = poisson(x, random);
    const Decomposition d = decompose_counts(counts, grid, {0.8 * sigma, 3, 1, 4}, run < 20 ? &course : nullptr);
    ASSERT_EQ(d.pulses.size(), size_t{1}) << run;
    centre.add(d.pulses[0].centre), told.add(std::sqrt(d.pulses[0].covariance[4]));
  }
  for (size_t k = 1; k < course.size(); ++k)
    if (!std::isnan(course[k]) && !std::isnan(course[k - 1])) {
      EXPECT_GE(course[k], course[k - 1] - 1e-7) << k;
    }
  const double mm = 1e3 * kSpeedOfLight / 2, scatter = std::sqrt(centre.variance()),
               error = scatter / std::sqrt(2.0 * 400);
  EXPECT_NEAR(mm * sigma / 10, 6.366, 2e-3);
  EXPECT_NEAR(scatter, sigma / 10, 4 * error);
  EXPECT_GT(std::fabs(scatter - 0.8 * sigma / 10), 4 * error);  // negative control
  EXPECT_NEAR(told.mean(), sigma / 10, 0.05 * sigma / 10);
}

}  // namespace
}  // namespace suite::returns_test
