// The hand-out of pieces played through: closed forms of how long threads take, and what talking adds.
#include "cluster/makespan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace suite::cluster::makespan_test {
namespace {

constexpr LinkCosts kFree{0, 0, 1e300, 1e300};

std::vector<TimedPiece> equal(size_t n, double seconds, double bytes = 0, bool continues = false) {
  return std::vector<TimedPiece>(n, {seconds, bytes, continues});
}

TEST(Makespan, EqualPiecesGoRound) {
  for (const int ranks : {1, 3, 64})
    for (const int threads : {1, 4}) {
      const Makespan m = makespan_of(equal(1000, 0.5), ranks, threads, kFree);
      const double rounds = std::ceil(1000.0 / (ranks * threads));
      EXPECT_DOUBLE_EQ(m.busy, 500);
      EXPECT_DOUBLE_EQ(m.trace, 0.5 * rounds);
      EXPECT_DOUBLE_EQ(m.whole, m.trace);
    }
}

TEST(Makespan, OnePieceHoldsUpAll) {
  std::vector<TimedPiece> pieces = equal(10, 1);
  pieces.insert(pieces.begin(), {100, 0, false});
  EXPECT_DOUBLE_EQ(makespan_of(pieces, 4, 2, kFree).trace, 100);
  pieces = equal(8, 1);
  pieces.push_back({100, 0, false});  // fetched last
  EXPECT_DOUBLE_EQ(makespan_of(pieces, 4, 2, kFree).trace, 101);
}

TEST(Makespan, OneRankNeedsNoMessages) {
  const Makespan m = makespan_of(equal(100, 1, 1e9, true), 1, 4, {1, 1, 1, 1});
  EXPECT_DOUBLE_EQ(m.whole, 25);
}

TEST(Makespan, ResultsComeOneAfterTheOther) {
  // Three of four ranks send 75 of 100 results, each of which takes the first rank 0.1 s, longer than making them.
  const Makespan m = makespan_of(equal(100, 0.01, 1e8), 4, 1, {0, 0, 1e300, 1e9});
  EXPECT_NEAR(m.whole, 0.01 + 75 * 0.1, 1e-9);
  EXPECT_NEAR(m.trace, 0.25, 1e-9);
}

TEST(Makespan, ThreadsGoOnWhileResultsTravel) {
  const Makespan m = makespan_of(equal(100, 1, 1e6), 2, 1, {0, 0.5, 1e300, 1e300});
  EXPECT_NEAR(m.whole, 50.5, 1e-9) << "only the last message is waited for";
}

TEST(Makespan, QuestionsAreWaitedFor) {
  // There and back, and the fetching, for each of the 25 pieces of the second rank but not of the first.
  const std::vector<TimedPiece> pieces = equal(50, 1, 0, true);
  const Makespan m = makespan_of(pieces, 2, 1, {0.001, 0.01, 1e300, 1e300});
  EXPECT_GT(m.whole, 25 + 24 * 0.021);
  EXPECT_LT(m.whole, 26.1);
}

TEST(Makespan, TellingGoesByATree) {
  const LinkCosts link{0, 1, 100, 1};
  EXPECT_EQ(broadcast_seconds(50, 1, link), 0);
  EXPECT_DOUBLE_EQ(broadcast_seconds(50, 2, link), 1.5);
  EXPECT_DOUBLE_EQ(broadcast_seconds(50, 64, link), 9);
}

}  // namespace
}  // namespace suite::cluster::makespan_test
