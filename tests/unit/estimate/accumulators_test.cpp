// Samples dealt to scrambles, the standard error that follows, and plans from pilots.
#include <gtest/gtest.h>

#include <cmath>

#include "estimate/budget.h"
#include "estimate/plan.h"
#include "math/sampling.h"

namespace suite::accumulators_test {
namespace {

TEST(Deal, counts_what_it_deals_and_never_repeats_a_point) {
  uint32_t count[8] = {};
  for (uint32_t n = 0; n < 2000; ++n) {
    for (uint32_t s = 0; s < 8; ++s) ASSERT_EQ(dealt(n, s), count[s]) << n << " samples, scramble " << s;
    const Deal d = deal(n);
    ASSERT_EQ(d.index, count[d.scramble]) << "indices of a scramble run without gaps";
    ++count[d.scramble];
  }
  EXPECT_EQ(scrambles_for(256), 4);
  EXPECT_EQ(scrambles_for(257), 8);
  for (uint32_t s = 0; s < 8; ++s) EXPECT_EQ(dealt(512, s), 64u);
}

// The mean of many squared standard errors is the variance of the mean, for even and uneven shares of the scrambles.
TEST(Accumulators, squared_standard_error_is_the_variance_of_the_mean) {
  for (const uint32_t n : {4u, 7u, 64u, 256u, 300u, 400u, 600u}) {
    Pcg32 random(n);
    constexpr int trials = 4000;
    double sum = 0, square = 0, claimed = 0;
    for (int t = 0; t < trials; ++t) {
      Accumulators a({1, 1, scrambles_for(n)});
      for (uint32_t s = 0; s < n; ++s) a.sums(0, static_cast<int>(deal(s).scramble))[0] += random.uniform();
      a.set_paths(0, n);
      double mean = 0, error = 0;
      a.estimate(0, 0, mean, error);
      sum += mean, square += mean * mean, claimed += error * error;
    }
    const double variance = square / trials - (sum / trials) * (sum / trials), expected = 1.0 / 12 / n;
    // Both figures scatter by sqrt(2 / (trials dof)) at most; 4 such deviations, dof >= 1 per trial for the claim.
    EXPECT_NEAR(variance / expected, 1, 4 * std::sqrt(2.0 / trials)) << n;
    EXPECT_NEAR(claimed / trials / expected, 1, 4 * std::sqrt(2.0 / trials)) << n;
  }
}

// Of four scrambles with one sample in a hundred rejected, intervals of Student's t at 95 % cover 95 %. Negative
// control: the way that was a bug, a scramble's sum over all of its samples against the mean of the accepted ones.
TEST(Accumulators, rejected_samples_do_not_count) {
  constexpr uint32_t n = 256;
  constexpr int trials = 4000;
  constexpr double t = 3.182446;
  Pcg32 random(9);
  int covered = 0, covered_by_all = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Accumulators a({1, 1, 4});
    for (uint32_t i = 0; i < n; ++i) {
      const int scramble = static_cast<int>(deal(i).scramble);
      if (random.uniform() < 0.01)
        ++a.failures(0, scramble);
      else
        a.sums(0, scramble)[0] += 0.9 + 0.2 * random.uniform();
    }
    a.set_paths(0, n);
    double mean = 0, error = 0, square = 0;
    a.estimate(0, 0, mean, error);
    std::vector<double> means(1), errors(1);
    a.estimate(0, means, errors);
    EXPECT_EQ(means[0], mean);
    EXPECT_EQ(errors[0], error);
    covered += std::fabs(mean - 1) <= t * error;
    for (int s = 0; s < 4; ++s) square += std::pow(a.sums(0, s)[0] / (n / 4) - mean, 2) / 12;
    covered_by_all += std::fabs(mean - 1) <= t * std::sqrt(square);
  }
  // Four deviations of the share of so many trials.
  EXPECT_NEAR(covered, 0.95 * trials, 4 * std::sqrt(trials * 0.95 * 0.05));
  EXPECT_GT(covered_by_all, 0.97 * trials);
}

TEST(Accumulators, shortfall_of_what_was_cut_and_missed) {
  Accumulators a({1, 2, 4, 0, true});
  a.set_paths(0, 100);
  const std::vector<double> means{3, 6};
  EXPECT_TRUE(a.lacking(0, means).empty());
  a.truncated(0, 0) = 25;  // T / (1 - T) = 1 / 3
  std::vector<double> light = a.lacking(0, means);
  ASSERT_EQ(light.size(), 2u);
  EXPECT_NEAR(light[0], 1, 1e-12);
  EXPECT_NEAR(light[1], 2, 1e-12);
  a.truncated(0, 0) = 100;
  EXPECT_NEAR(a.shortfall(0).cut, 999, 1e-6) << "paths that lose nothing";
  a.truncated(0, 0) = 0;
  // Met with a chance of 0.05 a path: five meetings are expected, of a mean of 2 and 4.
  for (int i = 0; i < 100; ++i) {
    a.missing(0, 0).light[0] += 2, a.missing(0, 0).light[1] += 4;
    *a.missing(0, 0).reference += 2, *a.missing(0, 0).square += 2 * 2 / 0.05;
  }
  light = a.lacking(0, means);
  ASSERT_EQ(light.size(), 2u);
  EXPECT_NEAR(light[0], 2 / std::sqrt(5), 1e-12);
  EXPECT_NEAR(light[1], 4 / std::sqrt(5), 1e-12);
  a.set_paths(0, 100);
  *a.missing(0, 0).square /= 4.01;  // 20 meetings
  EXPECT_EQ(a.shortfall(0).missing, 0);
  *a.missing(0, 0).square = INFINITY;  // something that is never met
  EXPECT_EQ(a.shortfall(0).missing, 1);
}

TEST(Accumulators, one_sample_tells_nothing_about_its_error) {
  Accumulators a({1, 1, 4});
  a.sums(0, 0)[0] = 3;
  a.set_paths(0, 1);
  double mean = 0, error = 0;
  a.estimate(0, 0, mean, error);
  EXPECT_EQ(mean, 3);
  EXPECT_EQ(error, INFINITY);
}

// Of two independent values the variance of the mean is (a - b)^2 / 4; of 0, 0, 0, 4 it is 12 / (4 * 3) = 1.
TEST(Accumulators, scatter_is_the_variance_of_the_mean_of_independent_samples) {
  Accumulators a({1, 1, 4});
  a.set_paths(0, 2);
  a.note_sample(0, 0, 1), a.note_sample(0, 1, 4);
  EXPECT_NEAR(a.scatter(0, 2.5), 2.25, 1e-12);
  Accumulators b({1, 1, 4});
  b.set_paths(0, 4);
  b.note_sample(0, 2, 4);
  EXPECT_NEAR(b.scatter(0, 1), 1, 1e-12);
}

// Where a scramble holds half of what counts or more, the scrambles weigh the same: of two values a and b the mean has
// the standard error |a - b| / 2, and of three that share 2 : 1 : 1 the squared deviations are divided by 3 * 2.
TEST(Accumulators, few_samples_share_the_error_evenly) {
  Accumulators two({1, 1, 4});
  two.sums(0, 0)[0] = 1, two.sums(0, 1)[0] = 4;
  two.set_paths(0, 2);
  double mean = 0, error = 0;
  two.estimate(0, 0, mean, error);
  EXPECT_NEAR(mean, 2.5, 1e-12);
  EXPECT_NEAR(error, 1.5, 1e-12);
  Accumulators three({1, 1, 4});
  three.set_paths(0, 5);  // 2, 1, 1, 1
  three.failures(0, 3) = 1;
  three.sums(0, 0)[0] = 2 * 4, three.sums(0, 1)[0] = 1, three.sums(0, 2)[0] = 7;  // their means: 4, 1, 7
  three.estimate(0, 0, mean, error);
  EXPECT_NEAR(mean, 4, 1e-12);
  EXPECT_NEAR(error, std::sqrt((0 + 9 + 9) / 6.0), 1e-12);
}

Capture capture_of(uint32_t columns, uint32_t rows) {
  Capture c;
  c.columns = columns, c.rows = rows;
  return c;
}

// A pilot in which every problem's scrambles have the means m (1 -+ d).
Accumulators pilot_of(size_t problems, double mean, double d, uint32_t paths) {
  Accumulators a({problems, 1, 4});
  for (size_t i = 0; i < problems; ++i) {
    for (int s = 0; s < 4; ++s) a.sums(i, s)[0] = mean * (1 + (s % 2 ? d : -d)) * paths / 4;
    a.set_paths(i, paths);
  }
  return a;
}

TEST(Plan, a_problem_does_not_look_at_itself) {
  const Capture c = capture_of(5, 5);
  Accumulators pilot = pilot_of(25, 1, 0.1, 32);
  const std::vector<JudgedBand> band{{0}};
  const std::vector<double> before = needs_of(c, pilot, band, {});
  for (int s = 0; s < 4; ++s) pilot.sums(12, s)[0] *= s == 0 ? 50 : 1;  // a firefly in the middle
  const std::vector<double> after = needs_of(c, pilot, band, {});
  EXPECT_EQ(after[12], before[12]);
  EXPECT_GT(after[11], 2 * before[11]);
}

TEST(Plan, counts_follow_from_variance_target_and_limits) {
  // Four scramble means 1 -+ 0.1: variance of the mean = 4 * 0.01 / 3 / 4, of one path 32 times that.
  const double variance = 32 * 0.04 / 12;
  const std::vector<JudgedBand> band{{0}};
  const std::vector<double> needs = needs_of(capture_of(3, 3), pilot_of(9, 1, 0.1, 32), band, {});
  for (const double n : needs) EXPECT_NEAR(n, variance, 1e-12);
  Convergence goal{32, 4096, 0.01, 0};
  EXPECT_EQ(paths_for(needs, {goal, {}})[4], static_cast<uint32_t>(std::ceil(variance / 1e-4 / 4) * 4));
  goal.max_paths = 100;
  EXPECT_EQ(paths_for(needs, {goal, {}})[4], 100u);
  goal.relative_error = 0.5;
  EXPECT_EQ(paths_for(needs, {goal, {}})[4], 32u);
  goal = {32, 4096, 0.01, 0};
  EXPECT_EQ(cap_for_total(needs, {goal, {}}, 9 * 200),
            200u);  // all nine want more than that, and 201 each does not fit
  EXPECT_EQ(cap_for_total(needs, {goal, {}}, 1), goal.min_paths);
}

// I, Q and U of four scrambles: Q = 0.3 (1 -+ 0.1), U = 0.4, so that the degree is 0.5 and 0.6 of Q's error is along
// it.
TEST(Plan, the_degree_of_polarisation_has_needs_of_its_own) {
  const auto pilot = [](double of_all, double of_q) {
    Accumulators a({9, 3, 4});
    for (size_t i = 0; i < 9; ++i) {
      for (int s = 0; s < 4; ++s) {
        const double sign = s % 2 ? 1 : -1, all = 2 * (1 + sign * of_all) * 8;
        a.sums(i, s)[0] = all, a.sums(i, s)[1] = 0.3 * (1 + sign * of_q) * all, a.sums(i, s)[2] = 0.4 * all;
      }
      a.set_paths(i, 32);
    }
    return a;
  };
  const std::vector<JudgedBand> degree{{0, 1, {}, JudgedBand::Degree{1, 2}}};
  const double variance = 32 * 0.04 / 12 * std::pow(0.6 * 0.3, 2);
  for (const double n : needs_of(capture_of(3, 3), pilot(0, 0.1), degree, {})) EXPECT_NEAR(n, variance, 1e-12);
  // The jackknife knows that the degree is bent in Q.
  EXPECT_NEAR(own_needs_of(pilot(0, 0.1), degree, {})[4], variance, 1e-3 * variance);
  // Light that is brighter and darker alike changes no degree; radiance has needs then.
  for (const double n : needs_of(capture_of(3, 3), pilot(0.1, 0), degree, {})) EXPECT_NEAR(n, 0, 1e-12);
  // Both: the larger need, each beside its own target.
  std::vector<JudgedBand> both{{0}, degree[0]};
  both[1].weight = std::pow(0.01 / 0.0001, 2);
  EXPECT_NEAR(needs_of(capture_of(3, 3), pilot(0, 0.1), both, {})[4], 1e4 * variance, 1e-8);
  // Below a floor the error counts less.
  EXPECT_NEAR(needs_of(capture_of(3, 3), pilot(0, 0.1), degree, Goals{{32, 64, 0.01, 20}, {}})[4], variance / 100,
              1e-12);
}

// One scramble brings 97 % of the light, with a degree of 0.4 or 0.6, the others have 0.5: a problem's own degree is
// nearly that of the bright one, and only those of the neighbours tell how far it is off.
TEST(Plan, a_degree_is_judged_beside_that_of_all_neighbours) {
  Accumulators pilot({9, 3, 4});
  for (size_t i = 0; i < 9; ++i) {
    for (int s = 0; s < 4; ++s) {
      const bool bright = s == static_cast<int>(i % 4);
      const double light = bright ? 97 : 1, degree = bright ? (i % 2 ? 0.4 : 0.6) : 0.5;
      pilot.sums(i, s)[0] = light, pilot.sums(i, s)[1] = degree * light, pilot.sums(i, s)[2] = 0;
    }
    pilot.set_paths(i, 32);
  }
  const std::vector<JudgedBand> degree{{0, 1, {}, JudgedBand::Degree{1, 2}}};
  // Residual 9.7 in one of four: means over 8 paths, variance of one path over the squared radiance.
  const double off = 9.7 / 8, radiance = 100.0 / 32, want = 32 * (0.75 * off * off / 12) / (radiance * radiance);
  EXPECT_NEAR(needs_of(capture_of(3, 3), pilot, degree, {})[4], want, 1e-9);
  EXPECT_LT(own_needs_of(pilot, degree, {})[4], 0.8 * want);
}

TEST(Plan, dark_problems_take_the_maximum_unless_a_floor_says_how_dark_is_dark) {
  Accumulators pilot = pilot_of(9, 1e-9, 0.5, 32);
  const std::vector<JudgedBand> band{{0}};
  const Convergence goal{32, 4096, 0.01, 0};
  EXPECT_GT(paths_for(needs_of(capture_of(3, 3), pilot, band, {}), {goal, {}})[4], 1000u);
  EXPECT_EQ(paths_for(needs_of(capture_of(3, 3), pilot, band, Goals{{64, 64, 0, 1e-3}, {}}), {goal, {}})[4], 32u);
}

TEST(Goal, budget_over_capture) {
  Capture c = capture_of(2, 2);
  c.convergence = {64, 64, 0, 0};
  Budget b;
  EXPECT_EQ(goal_of(c, b).max_paths, 64u);
  b.more = 64;
  EXPECT_EQ(goal_of(c, b).max_paths, 128u);
  EXPECT_EQ(goal_of(c, b).min_paths, 128u);
  b = {};
  b.relative_error = 0.02;  // a target frees a fixed count
  EXPECT_EQ(goal_of(c, b).min_paths, kDefaultPilot);
  EXPECT_EQ(goal_of(c, b).max_paths, kDefaultMost);
  b.min_paths = 16, b.max_paths = 500;
  EXPECT_EQ(goal_of(c, b).min_paths, 16u);
  EXPECT_EQ(goal_of(c, b).max_paths, 500u);
  // What a capture says of its maximum holds, though it has a target and as large a minimum.
  c.convergence = {16, 16, 0.01, 0};
  b = {};
  EXPECT_EQ(goal_of(c, b).max_paths, 16u);
  EXPECT_EQ(goal_of(c, b).min_paths, 16u);
}

}  // namespace
}  // namespace suite::accumulators_test
