// Forecasts of the time that is left: start-up does not count, uneven work gives a range, too little gives no number.
#include "base/time_left.h"

#include <gtest/gtest.h>

namespace suite::time_left_test {
namespace {

constexpr TimeLeft::Bounds kLeast{TimeLeft::Total::least};

// 100 units at one a second after a start of 40 s, whose mean rate would say 490 s after the tenth.
TEST(TimeLeft, StartUpDoesNotCount) {
  TimeLeft left(100, {});
  EXPECT_EQ(left.text(), "time left not known yet");
  for (int k = 1; k <= 11; ++k) left.tell(40 + k, k);
  EXPECT_EQ(left.text(), "89.0 s left");
}

TEST(TimeLeft, IsNotKnownByTooLittle) {
  TimeLeft left(1000, {});
  left.tell(40, 20);  // the first piece of work, with what came before it
  EXPECT_EQ(left.text(), "time left not known yet");
  left.tell(40.5, 60);  // too short
  EXPECT_EQ(left.text(), "time left not known yet");
  TimeLeft slow(1000, {});
  slow.tell(1, 1), slow.tell(100, 5);  // 0.4 % of the whole
  EXPECT_EQ(slow.text(), "time left not known yet");
}

// Ten units at one a second, ten more at a quarter.
TEST(TimeLeft, UnevenWorkGivesARange) {
  TimeLeft left(100, {});
  for (int k = 1; k <= 11; ++k) left.tell(k, k);
  for (int k = 1; k <= 10; ++k) left.tell(11 + 4 * k, 11 + k);
  EXPECT_EQ(left.text(), "3 min 17 s to 5 min 16 s left");
}

TEST(TimeLeft, WhereMoreMayComeItIsALowerBound) {
  TimeLeft left(100, kLeast);
  for (int k = 1; k <= 11; ++k) left.tell(k, k);
  EXPECT_EQ(left.text(), "at least 89.0 s left");
  for (int k = 12; k <= 120; ++k) left.tell(k, k);
  EXPECT_EQ(left.text(), "time left not known yet");
}

TEST(TimeLeft, ATimeLimitBoundsIt) {
  TimeLeft left(100, {.seconds = 60});
  left.tell(1, 0);
  EXPECT_EQ(left.text(), "at most 59.0 s left");
  for (int k = 1; k <= 11; ++k) left.tell(k, k);
  EXPECT_EQ(left.text(), "at most 49.0 s left");
}

// Of very many reports few are kept, and they say the same.
TEST(TimeLeft, ManyReportsSayTheSame) {
  TimeLeft left(1000500, {});
  for (int k = 1; k <= 500000; ++k) left.tell(1e-3 * k, k);
  EXPECT_EQ(left.text(), "8 min 20 s left");
}

}  // namespace
}  // namespace suite::time_left_test
