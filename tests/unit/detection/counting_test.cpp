// Detectors that count against closed forms: first photons, blocking, dead times, afterpulses, cross-talk.
#include "detection/counting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "math/stats.h"
#include "math/variates.h"
#include "spectral/planck.h"
#include "support/message_of.h"

namespace suite::counting_test {
namespace {

constexpr double kNs = 1e-9;

Expected pulse_of(double electrons, double step, double background = 0) {
  Expected e = expect_electrons(std::vector<PhotonArrival>{{10 * kNs, electrons, 0}}, 0, PulseShape::gaussian(kNs),
                                {1, 0}, samples_within(0, 20 * kNs, step));
  e.background = background;
  return e;
}
Expected even_rate(double rate, double gate, size_t samples) {
  const SampleGrid grid = samples_within(0, gate, gate / static_cast<double>(samples));
  return {grid, std::vector<double>(grid.count, 0), std::vector<double>(grid.count, 0), rate * grid.step};
}

// Walk and spread of the first photon of a pulse of 1 ns, N primaries: the density N g(t) exp(-N G(t)), integrated.
TEST(Counting, WalkOfTheFirstPhoton) {
  struct Row {
    double n, walk_mm, deviation_ns;
  };
  for (const Row& r : {Row{0.1, -1.80, 0.4246}, Row{1, -17.70, 0.4177}, Row{2, -33.99, 0.3993}, Row{5, -68.85, 0.3271},
                       Row{10, -95.77, 0.2651}}) {
    const FirstCount f = first_count(pulse_of(r.n, 0.002 * kNs));
    EXPECT_NEAR(f.any, 1 - std::exp(-r.n), 1e-9);
    EXPECT_NEAR((f.mean - 10 * kNs) * kSpeedOfLight / 2 * 1e3, r.walk_mm, 6e-3) << r.n;
    EXPECT_NEAR(f.deviation / kNs, r.deviation_ns, 6e-5) << r.n;
  }
}

// Dark counts before the target: 20 kHz and 2 us block 3.92 %, 1 MHz and 1 us 63.2 %.
TEST(Counting, DarkCountsBlock) {
  EXPECT_NEAR(first_count(even_rate(20e3, 2e-6, 100)).any, 0.0392, 5e-5);
  EXPECT_NEAR(first_count(even_rate(1e6, 1e-6, 100)).any, 0.632, 2e-4);
}

// The simulation against first_count(): chi-square of times, and the share of gates with a count.
TEST(Counting, FramedPixelsFollowTheClosedForm) {
  constexpr size_t kGates = 40000;
  const Expected e = pulse_of(1, 0.25 * kNs, 0.002);
  const auto p_of = [&](const Expected& model) {
    const FirstCount f = first_count(model);
    std::vector<double> observed(e.grid.count + 1, 0), expected;
    for (const double p : f.probability) expected.push_back(p * kGates);
    expected.push_back((1 - f.any) * kGates);
    for (uint64_t gate = 0; gate < kGates; ++gate) {
      Pcg32 random = stream_of(3, 1, gate);
      const auto clicks = count_primaries({}, {&e, 1}, 1, random);
      EXPECT_LE(clicks.size(), size_t{1});
      if (clicks.empty()) ++observed.back();
      for (const Click& c : clicks) ++observed[static_cast<size_t>(c.time / e.grid.step)];
    }
    return chi_square_test(observed, expected, 5);
  };
  EXPECT_GT(p_of(e), 1e-3);
  EXPECT_LT(p_of(pulse_of(1.08, 0.25 * kNs, 0.002)), 1e-6);  // negative control
}

// 1e7 counts/s and 22 ns: r / (1 + r tau) = 8.197e6 and r exp(-r tau) = 8.025e6. Variance of the number of a renewal
// process: T var / mean^3 of its intervals, below T rate in both.
TEST(Counting, DeadTimes) {
  const double rate = 1e7, dead = 22 * kNs, gate = 10e-3;
  const Expected e = even_rate(rate, gate, 1000);
  const auto measured = [&](bool paralysable) {
    CountingSpec spec;
    spec.dead = dead, spec.paralysable = paralysable;
    Pcg32 random = stream_of(4, 0, paralysable);
    return static_cast<double>(count_primaries(spec, {&e, 1}, 1, random).size()) / gate;
  };
  const double still = measured(false), longer = measured(true);
  const double still_error = std::sqrt(rate / std::pow(1 + rate * dead, 3) / gate),
               longer_error = std::sqrt(8.025e6 / gate);
  EXPECT_NEAR(still, 8.197e6, 4 * still_error);
  EXPECT_NEAR(longer, 8.025e6, 4 * longer_error);
  EXPECT_GT(std::fabs(still - rate / (1 + rate * 30 * kNs)), 4 * still_error);  // negative control: another dead time
}

// Afterpulses that may pulse again: 1 / (1 - p) clicks a primary.
TEST(Counting, Afterpulses) {
  CountingSpec spec;
  spec.dead = 0, spec.afterpulse = 0.3, spec.afterpulse_time = 5 * kNs;
  const Expected e = even_rate(1e6, 10e-3, 100);
  Pcg32 random = stream_of(5, 0, 0);
  double primaries = 0, all = 0;
  for (const Click& c : count_primaries(spec, {&e, 1}, 1, random))
    ++all, primaries += c.cause == Click::Cause::background;
  // Geometric number of clicks: variance p / (1 - p)^2 a primary.
  const double error = std::sqrt(0.3 / 0.49 / primaries);
  EXPECT_NEAR(all / primaries, 1 / 0.7, 4 * error);
  EXPECT_GT(std::fabs(all / primaries - 1 / 0.66), 4 * error);  // negative control
}

// A neighbour in the dark counts with the probability of cross-talk, and jitter is what it is told to be.
TEST(Counting, CrossTalkAndJitter) {
  CountingSpec spec;
  spec.crosstalk = 0.1, spec.jitter = 2 * kNs;
  const std::vector<Expected> pair{pulse_of(60, 0.25 * kNs), pulse_of(0, 0.25 * kNs)};
  double neighbours = 0;
  RunningStats difference;
  constexpr int kGates = 20000;
  for (uint64_t gate = 0; gate < kGates; ++gate) {
    Pcg32 random = stream_of(6, 0, gate);
    const auto clicks = count_primaries(spec, pair, 2, random);
    if (clicks.size() < 2) continue;
    ++neighbours;
    EXPECT_EQ(clicks[1].cause, Click::Cause::crosstalk);
    difference.add(clicks[1].time - clicks[0].time);  // of two jitters
  }
  EXPECT_NEAR(neighbours / kGates, 0.1, 4 * std::sqrt(0.09 / kGates));
  const double expected = std::sqrt(2.0) * 2 * kNs / kFwhmOfDeviation, found = std::sqrt(difference.variance());
  EXPECT_NEAR(found, expected, 4 * expected / std::sqrt(2 * neighbours));
}

// m pixels behind a spot, blind for longer than the pulse: m (1 - exp(-N / m)) counts. Strong and weak beams.
TEST(Counting, PixelsBehindOneSpot) {
  for (const uint32_t m : {4u, 16u}) {
    Expected part = pulse_of(10.0 / m, 0.25 * kNs);
    const std::vector<Expected> pixels(m, part);
    CountingSpec spec;
    spec.dead = 1e-6;
    RunningStats counts;
    for (uint64_t pulse = 0; pulse < 4000; ++pulse) {
      Pcg32 random = stream_of(9, m, pulse);
      counts.add(static_cast<double>(count_primaries(spec, pixels, m, random).size()));
    }
    EXPECT_NEAR(counts.mean(), m * (1 - std::exp(-10.0 / m)), 4 * counts.stderr_of_mean()) << m;
    EXPECT_GT(std::fabs(counts.mean() - 10), 4 * counts.stderr_of_mean());  // not without the loss
  }
}

TEST(Counting, HoldOffResolutionAndTooManyEvents) {
  CountingSpec spec;
  spec.hold_off = 12 * kNs, spec.resolution = kNs;
  const Expected e = pulse_of(1000, 0.25 * kNs, 1);
  Pcg32 random = stream_of(10, 0, 0);
  const auto clicks = count_primaries(spec, {&e, 1}, 1, random);
  ASSERT_EQ(clicks.size(), size_t{1});
  EXPECT_GT(clicks[0].time, 12 * kNs);
  EXPECT_NEAR(clicks[0].time / kNs - std::floor(clicks[0].time / kNs), 0.5, 1e-6);
  CountingSpec open;
  open.dead = 0;
  const Expected bright = pulse_of(1e9, kNs);  // a retro-reflector
  EXPECT_THAT(message_of([&] {
                count_primaries(open, {&bright, 1}, 1, random);
              }),
              testing::HasSubstr("more than 1e6 events"));
  EXPECT_EQ(count_primaries(CountingSpec{}, {&bright, 1}, 1, random).size(), size_t{1});
}

// McIntyre: k 0.02, M 100: 3.950; k 0.2, M 10: 3.52. Mean and variance of avalanches, 4 sigma.
TEST(Counting, Avalanches) {
  EXPECT_NEAR(excess_noise(0.02, 100), 3.9502, 1e-4);
  EXPECT_NEAR(excess_noise(0.2, 10), 3.52, 1e-12);
  Pcg32 random(11);
  RunningStats electrons;
  constexpr int kRuns = 40000;
  for (int k = 0; k < kRuns; ++k) electrons.add(avalanche(poisson(6, random), 10, 3.52, random));
  EXPECT_NEAR(electrons.mean(), 60, 4 * electrons.stderr_of_mean());
  const double expected = 6 * 100 * 3.52;  // N M^2 F
  // The fourth moment of a compound Poisson sum of gamma variates makes the variance's error some twice the normal one.
  EXPECT_NEAR(electrons.variance(), expected, 4 * 2 * expected * std::sqrt(2.0 / kRuns));
  EXPECT_GT(std::fabs(electrons.variance() - 6 * 100 * 3.0), 4 * 2 * expected * std::sqrt(2.0 / kRuns));
}

}  // namespace
}  // namespace suite::counting_test
