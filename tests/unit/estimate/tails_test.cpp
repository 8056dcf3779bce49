// The rule behind quality_heavy_tail on made-up problems: what it must find, what it must leave alone.
#include "estimate/tails.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sensor/quality.h"

namespace suite::tails_test {
namespace {

constexpr uint32_t kSide = 21, kPaths = 64;

// kSide x kSide problems of radiance 1 without noise.
struct Picture {
  std::vector<TailSums> of = std::vector<TailSums>(size_t{kSide} * kSide, {1, 0, 0, 1, kPaths, kTailShare, 0});
  TailSums& at(uint32_t x, uint32_t y) { return of[y * kSide + x]; }
  std::vector<uint8_t> flags(bool neighbours = true) const {
    std::vector<uint8_t> quality(of.size());
    std::vector<TailSums> sums = of;
    for (TailSums& t : sums) t.sampled = t.error;  // as when nothing was pooled
    flag_heavy_tails(sums, kSide, neighbours, quality);
    return quality;
  }
  size_t flagged(bool neighbours = true) const {
    size_t n = 0;
    for (const uint8_t q : flags(neighbours)) n += q == quality_heavy_tail;
    return n;
  }
};
// What `count` events of `value` among the paths leave, dealt as unevenly as chance has it on the mean.
TailSums events(double count, double value) {
  const double error = std::sqrt(count) * value / kPaths;
  return {count * value / kPaths, error, error, static_cast<float>(value), kPaths, kTailShare, 0};
}

// Found as 59 % of a picture without noise: the variances of rounding errors were compared with each other.
TEST(Tails, RoundingErrorsAreNoTails) {
  Picture p;
  for (size_t i = 0; i < p.of.size(); ++i) p.of[i].error = i % 3 ? 1e-17 : 1e-9;
  EXPECT_EQ(p.flagged(), 0u);
}

TEST(Tails, AnEdgeFlagsNeitherSide) {
  // Columns 0..9 at 1, 11.. at 3 and without noise, column 10 mixed and noisy; then one mixed so little that it looks
  // like either side.
  for (const double mixed : {2.0, 1.05}) {
    Picture p;
    for (uint32_t y = 0; y < kSide; ++y) {
      for (uint32_t x = 11; x < kSide; ++x) p.at(x, y).mean = 3, p.at(x, y).largest = 3;
      p.at(10, y).mean = mixed, p.at(10, y).error = 0.05, p.at(10, y).largest = 3;
    }
    EXPECT_EQ(p.flagged(), 0u) << mixed;
    // The edge runs through this one, and none of its paths saw the other side.
    if (mixed == 1.05) {
      p.at(10, 10).mean = 1, p.at(10, 10).error = 0, p.at(10, 10).largest = 1;
      EXPECT_TRUE(p.flags()[10 * kSide + 10]);
      EXPECT_EQ(p.flagged(), 1u);
    }
  }
}

TEST(Tails, WhatEveryFourthNeighbourSawIsMissing) {
  Picture p;
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x) {
      const bool saw = x % 2 == 0 && y % 2 == 0;
      p.at(x, y) = saw ? events(1, 100) : TailSums{0.1, 0, 0, 0.1f, kPaths, kTailShare, 0};
    }
  const std::vector<uint8_t> flags = p.flags();
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x)
      EXPECT_TRUE(flags[y * kSide + x] || (x % 2 == 0 && y % 2 == 0)) << x << ", " << y;
  // Without neighbours nothing is known about what was not seen.
  EXPECT_EQ(p.flagged(false), 0u);
}

TEST(Tails, EventsDealtEvenlyAreFewAllTheSame) {
  // One event in each of four scrambles: a standard error of 0, and a count that may as well have been 1 or 8.
  Picture p;
  for (TailSums& s : p.of) s = events(4, 16);
  p.at(10, 10).error = 0;
  for (const bool neighbours : {true, false}) {
    EXPECT_EQ(p.flagged(neighbours), 1u);
    EXPECT_TRUE(p.flags(neighbours)[10 * kSide + 10]);
  }
  // The lit half of a problem, dealt to the scrambles without any difference: two samples could hide. Where every
  // path is alike there is nothing to deal.
  p.at(10, 10).largest = 2;
  EXPECT_EQ(p.flagged(false), 1u);
  p.at(10, 10).largest = 1;
  EXPECT_EQ(p.flagged(false), 0u);
}

TEST(Tails, TheTargetAndItsFloorSayWhatMatters) {
  Picture p;
  for (TailSums& s : p.of) s.error = 0.03;
  p.at(10, 10).error = 0;
  EXPECT_EQ(p.flagged(), 1u);
  p.at(10, 10).share = 0.05;  // a target of 5 %
  EXPECT_EQ(p.flagged(), 0u);
  p.at(10, 10).share = kTailShare;
  p.at(10, 10).floor = 4;  // 1 % of what counts as bright is more than what may be missing
  EXPECT_EQ(p.flagged(), 0u);
}

// Found on open ground beside a building: on some side none of the two next problems had met it, and nothing was known.
TEST(Tails, WhatIsMetSeldomIsKnownFromFurtherAway) {
  Picture p;
  for (uint32_t i = 0; i < kSide; ++i) p.at(7, i) = p.at(13, i) = p.at(i, 7) = p.at(i, 13) = events(1, 2);
  for (TailSums& s : p.of) s.mean = 1;
  const std::vector<double> errors = errors_around(p.of, kSide);
  EXPECT_GT(errors[10 * kSide + 10], 0) << "three problems away on all sides";
  EXPECT_LT(errors[10 * kSide + 10], 2.0 / kPaths);
  EXPECT_EQ(errors[2 * kSide + 2], 0) << "negative control: on the side of the rim nobody knows";
}

TEST(Tails, NoErrorIsNothingWhereOneNearbySawSomething) {
  // Light met from the west only, so that to the east nobody tells: one in ten of the problems there saw it.
  Picture p;
  for (TailSums& s : p.of) s.error = s.sampled = 0;
  for (uint32_t y = 0; y < kSide; y += 3)
    for (uint32_t x = 0; x < 7; x += 3) p.at(x, y).sampled = p.at(x, y).error = 0.001;
  p.at(12, 10).mean = 2, p.at(12, 10).sampled = 0.5;  // another kind of thing, which tells nobody
  const std::vector<double> errors = errors_around(p.of, kSide);
  for (uint32_t y = 0; y < kSide; ++y) {
    EXPECT_GT(errors[y * kSide + 9], 0) << y;
    EXPECT_LT(errors[y * kSide + 9], 0.001) << y;
    EXPECT_EQ(errors[y * kSide + 17], 0) << "all within four are without noise";
  }
}

TEST(Tails, OddShapesAndUnknownErrors) {
  for (const uint32_t columns : {1u, 9u}) {  // a column, a row
    std::vector<TailSums> of(9, {1, 0.1, 0.1, 1, kPaths, kTailShare, 0});
    for (const size_t i : {0u, 4u}) of[i].error = of[i].sampled = 0;
    std::vector<uint8_t> quality(9);
    flag_heavy_tails(of, columns, true, quality);
    EXPECT_EQ(quality, (std::vector<uint8_t>{1, 0, 0, 0, 1, 0, 0, 0, 0})) << columns;
  }
  // Found at the rim of a picture: of the half-plane mostly outside, the few problems inside saw nothing, and decided.
  Picture p;
  for (TailSums& s : p.of) s.error = 0.1;
  for (uint32_t i = 0; i < kSide; ++i) p.at(i, 0).error = p.at(0, i).error = 0;
  EXPECT_EQ(p.flagged(), 2 * size_t{kSide} - 1);
  // One path: its standard error is infinite, and says so itself.
  for (TailSums& s : p.of) s.error = INFINITY, s.paths = 1;
  EXPECT_EQ(p.flagged(), 0u);
}

TEST(Quality, BitsAreNamedOnceAndCounted) {
  uint8_t all = 0;
  for (const QualityBit& b : quality_bits()) {
    EXPECT_FALSE(all & b.bit) << b.name;
    EXPECT_EQ(b.bit & (b.bit - 1), 0) << b.name << " is one bit";
    all = static_cast<uint8_t>(all | b.bit);
    EXPECT_FALSE(b.name.empty() || b.meaning.empty());
  }
  EXPECT_EQ(all, quality_heavy_tail | quality_failures | quality_truncated | quality_unresolved | quality_clipped |
                     quality_no_information);
  QualityCounts counts;
  counts.add(std::vector<uint8_t>{0, 1, 3, 12});
  EXPECT_EQ(counts.problems, 4u);
  EXPECT_EQ(counts.flagged, 3u);
  EXPECT_EQ(counts.with(quality_heavy_tail), 2u);
  EXPECT_EQ(counts.with(quality_unresolved), 1u);
  EXPECT_EQ(text_of(counts), "heavy_tail 2, failures 1, truncated 1, unresolved 1");
}

}  // namespace
}  // namespace suite::tails_test
