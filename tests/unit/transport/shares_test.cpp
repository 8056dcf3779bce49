// Russian roulette of paths that lose nothing.
#include "transport/shares.h"

#include <gtest/gtest.h>

#include <cmath>

#include "transport/dimensions.h"

namespace suite::test::shares_test {
namespace {

// The share of paths with all of their light that is left behind `events` events.
double reached(uint64_t events) {
  double light = 1, share = 1;
  for (uint64_t n = 1; n <= events; ++n) {
    const double alive = survival(light, n, 3);
    share *= alive, light /= alive;
  }
  EXPECT_NEAR(share * light, 1, 1e-9) << events;
  return share;
}

// Weights grow as a power, so that light of the latest orders is not left to paths that never occur: a thousandth at
// every event would leave e^-90 of them at 1e5.
TEST(Roulette, PathsWithoutLossesEndByAPower) {
  EXPECT_EQ(reached(10000), 1);
  EXPECT_NEAR(reached(100000), 0.1, 1e-3);
  EXPECT_NEAR(reached(1000000), 0.01, 1e-4);
  EXPECT_LT(reached(5000000), 0.01 * std::exp(-3.9)) << "they end";
}

TEST(Roulette, LaterEventsHaveNumbersOfTheirOwn) {
  constexpr uint32_t kSpan = dimensions::kStride / 16;
  const SampleStream stream(1, 2, 3);
  const double first = dimensions::of_roulette(stream, 7, 20000);
  EXPECT_EQ(first, stream.hashed(7, dimensions::roulette(20000)));
  EXPECT_NE(first, dimensions::of_roulette(stream, 7, 20000 + kSpan));
  EXPECT_NE(dimensions::of_roulette(stream, 7, 20000 + kSpan), dimensions::of_roulette(stream, 7, 20000 + 2 * kSpan));
}

}  // namespace
}  // namespace suite::test::shares_test
