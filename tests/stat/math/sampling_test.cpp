// Sample streams: uniform over problems, independent between blocks and scrambles, unbiased, far better than random
// numbers on smooth integrands, and with error bars that cover. Significance 1e-4, fixed seeds.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "math/sampling.h"
#include "math/stats.h"

namespace suite::sampling_test {

namespace {

constexpr double kSignificance = 1e-4;

// p-value of the pair (x, y) over n draws being uniform on the unit square, 32 x 32 cells.
double p_of_pairs(const std::function<Vec2(uint32_t)>& draw, uint32_t n = 400'000) {
  std::vector<double> observed(1024), expected(1024, n / 1024.0);
  for (uint32_t i = 0; i < n; ++i) {
    const Vec2 p = draw(i);
    ++observed[static_cast<size_t>(p.x * 32) * 32 + static_cast<size_t>(p.y * 32)];
  }
  return chi_square_test(observed, expected, 5);
}

}  // namespace

TEST(StreamStatistics, AnyTwoNumbersOfDifferentProblemsAreIndependent) {
  // Neighbouring pixels, the same sample: what a correlated hash would spoil first.
  EXPECT_GT(p_of_pairs([](uint32_t i) {
              return Vec2{SampleStream(1, 0, i).draw(0, 0)[0], SampleStream(1, 0, i + 1).draw(0, 0)[0]};
            }),
            kSignificance);
  EXPECT_GT(p_of_pairs(
                [](uint32_t i) {
                  return Vec2{SampleStream(1, 0, i).draw(0, 0)[0], SampleStream(1, 0, i).draw(1, 0)[3]};
                },
                200'000),
            kSignificance);
  EXPECT_GT(p_of_pairs([](uint32_t i) {
              return Vec2{SampleStream(i, 0, 0).draw(7, 2)[1], SampleStream(i, 1, 0).draw(7, 2)[1]};
            }),
            kSignificance);
  EXPECT_GT(p_of_pairs([](uint32_t i) {
              return Vec2{SampleStream(1, 0, i, 0).draw(3, 0)[2], SampleStream(1, 0, i, 1).draw(3, 0)[2]};
            }),
            kSignificance);
  EXPECT_GT(p_of_pairs([](uint32_t i) {
              return Vec2{SampleStream(1, 0, i).draw(0, 0)[0], SampleStream(1, 0, i).draw(0, 1)[0]};
            }),
            kSignificance);
  EXPECT_GT(p_of_pairs([](uint32_t i) {
              return Vec2{SampleStream(1, 0, i).draw(0, 0)[0], SampleStream(1, 0, i).draw(0, 0)[2]};
            }),
            kSignificance);
  // Negative controls: the same number twice; unscrambled points of one sample over problems; 2 % too many small ones.
  EXPECT_LT(p_of_pairs([](uint32_t i) {
              const double u = SampleStream(1, 0, i).draw(0, 0)[0];
              return Vec2{u, u};
            }),
            kSignificance);
  EXPECT_LT(p_of_pairs([](uint32_t i) {
              return Vec2{unit_double(sobol4(i, 0)), unit_double(sobol4(0, 1))};
            }),
            kSignificance);
  EXPECT_LT(p_of_pairs([](uint32_t i) {
              return Vec2{std::pow(SampleStream(1, 0, i).draw(0, 0)[0], 1.04), SampleStream(1, 0, i + 1).draw(0, 0)[0]};
            }),
            kSignificance);
}

TEST(StreamStatistics, HashedNumbersAreIndependentOfTheStratifiedOnesAndOfEachOther) {
  EXPECT_GT(p_of_pairs([](uint32_t i) {
              const SampleStream s(1, 0, i / 64);
              return Vec2{s.hashed(i % 64, 0), s.draw(i % 64, 0)[0]};
            }),
            kSignificance);
  EXPECT_GT(p_of_pairs([](uint32_t i) {
              const SampleStream s(1, 0, 0);
              return Vec2{s.hashed(i, 0), s.hashed(i, 1)};
            }),
            kSignificance);
  EXPECT_GT(p_of_pairs([](uint32_t i) {
              const SampleStream s(1, 0, 0);
              return Vec2{s.hashed(i, 0), s.hashed(i + 1, 0)};
            }),
            kSignificance);
  EXPECT_LT(p_of_pairs([](uint32_t i) {
              const SampleStream s(1, 0, 0);
              return Vec2{s.hashed(i, 0), s.hashed(i & ~1u, 0)};
            }),
            kSignificance);
}

TEST(StreamStatistics, ScrambledMeansAreUnbiasedAndFarBelowRandomVariance) {
  // Integral of exp(x + y z + w) over the unit cube of four dimensions: (e - 1)^2 times sum 1/(k! (k+1)^2).
  double inner = 0, factorial = 1;
  for (int k = 0; k < 20; ++k) inner += 1 / (factorial * (k + 1) * (k + 1)), factorial *= k + 1;
  const double exact = std::pow(std::exp(1.0) - 1, 2) * inner;
  constexpr uint32_t kSamples = 256;
  RunningStats scrambled, random, control;
  Pcg32 rng(11);
  for (uint32_t problem = 0; problem < 4000; ++problem) {
    const SampleStream stream(5, 0, problem);
    double a = 0, b = 0, c = 0;
    for (uint32_t i = 0; i < kSamples; ++i) {
      const auto u = stream.draw(i, 0);
      a += std::exp(u[0] + u[1] * u[2] + u[3]) / kSamples;
      c += std::exp(u[0] + u[1] * u[2] + u[3]) * (1 + 0.02 * (u[0] - 0.4)) / kSamples;
      const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform(), w = rng.uniform();
      b += std::exp(x + y * z + w) / kSamples;
    }
    scrambled.add(a), random.add(b), control.add(c);
  }
  const auto p = [&](const RunningStats& s) { return normal_two_sided((s.mean() - exact) / s.stderr_of_mean()); };
  EXPECT_GT(p(scrambled), kSignificance);
  EXPECT_GT(p(random), kSignificance);
  EXPECT_LT(p(control), kSignificance);
  EXPECT_LT(scrambled.variance(), 0.01 * random.variance());
}

TEST(StreamStatistics, StudentIntervalsFromFourScramblesCover) {
  // Block means of 4 independent scrambles, 95 %: 6000 trials put the share within 0.95 +- 0.011 (4 sigma).
  const double t = student_t_quantile(0.95, 3);
  int covered = 0, narrow = 0;
  constexpr int kTrials = 6000;
  for (uint32_t trial = 0; trial < kTrials; ++trial) {
    RunningStats blocks;
    for (uint32_t scramble = 0; scramble < 4; ++scramble) {
      const SampleStream stream(9, 0, trial, scramble);
      double mean = 0;
      for (uint32_t i = 0; i < 16; ++i) {
        const auto u = stream.draw(i, 0);
        mean += (u[0] * u[0] + u[1]) / 16;
      }
      blocks.add(mean);
    }
    const double miss = std::fabs(blocks.mean() - (1.0 / 3 + 0.5));
    covered += miss <= t * blocks.stderr_of_mean();
    narrow += miss <= 1.96 * blocks.stderr_of_mean();  // negative control: the normal factor is too small for 4 blocks
  }
  EXPECT_NEAR(covered / double{kTrials}, 0.95, 0.0113);
  EXPECT_LT(narrow / double{kTrials}, 0.95 - 0.0113);
}

}  // namespace suite::sampling_test
