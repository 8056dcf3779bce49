// The laws that chains of scatterings are drawn by say the densities with which they draw.
#include "transport/chain_laws.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace suite::test::chain_laws_test {
namespace {

TEST(ChainLaws, CountsAreDrawnWithTheirProbabilities) {
  constexpr int kMost = 24, kDraws = 200000;
  for (const int least : {0, 1})
    for (const double depth : {1e-6, 0.3, 8.0})
      for (const double albedo : {0.01, 0.9, 1.0}) {
        const LinkCount count(depth, albedo, least, kMost);
        std::vector<int> drawn(kMost + 1);
        for (int i = 0; i < kDraws; ++i) ++drawn[static_cast<size_t>(count.draw((i + 0.5) / kDraws))];
        double sum = 0;
        for (int n = least; n <= kMost; ++n) {
          sum += count.probability(n);
          // Even numbers: off by those at its ends at most.
          EXPECT_NEAR(drawn[static_cast<size_t>(n)], kDraws * count.probability(n), 2) << n << " at " << depth;
        }
        EXPECT_NEAR(sum, 1, 1e-12);
        EXPECT_EQ(least == 1 ? drawn[0] : 0, 0);
        EXPECT_LE(count.draw(std::nextafter(1.0, 0.0)), kMost);
      }
}

// The tail: without it a chain of 15 on a way of depth 1 would be drawn with a probability of 3e-13.
TEST(ChainLaws, LongChainsAreNotRareOnShortWays) { EXPECT_GT(LinkCount(1, 0.9, 1, 24).probability(15), 1e-4); }

TEST(ChainLaws, PlacesAreDrawnWithTheirDensities) {
  constexpr int kBins = 20, kSteps = 500;
  for (const double more : {-1e9, -30.0, -3.0, -0.1, 0.0, 0.4, 2.0, 29.0, 1e9})
    for (const int others : {0, 3, 23}) {  // 3: of -3 they leave nothing
      const LinkPlace place(more, others);
      std::vector<double> drawn(kBins);
      for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
          const double x = place.draw({(i + 0.5) / kSteps, (j + 0.5) / kSteps});
          ASSERT_TRUE(x >= 0 && x <= 1) << more << " " << others;
          drawn[std::min<size_t>(kBins - 1, static_cast<size_t>(x * kBins))] += 1.0 / (kSteps * kSteps);
        }
      for (size_t b = 0; b < kBins; ++b) {
        double share = 0;  // by the midpoint rule
        for (int k = 0; k < 1000; ++k) share += place.density((static_cast<double>(b) + (k + 0.5) / 1000) / kBins);
        EXPECT_NEAR(drawn[b], share / 1000 / kBins, 5e-3) << more << " " << others << " bin " << b;
      }
    }
}

}  // namespace
}  // namespace suite::test::chain_laws_test
