// Which row of a control table holds when, once and over and over.
#include "motion/timetable.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace suite::timetable_test {
namespace {

using Rows = std::vector<std::tuple<int, double, double>>;  // row (-1 = none), from, until

Rows rows_over(const Timetable& table, double begin, double end) {
  Rows rows;
  table.over({begin, end}, [&](std::optional<size_t> row, TimeSpan held) {
    rows.push_back({row ? static_cast<int>(*row) : -1, held.begin, held.end});
  });
  return rows;
}

TEST(Timetable, ARowHoldsFromItsTimeUntilTheNext) {
  const Timetable table{{0, 10, 12.5}};
  EXPECT_EQ(table.at(-1e-12), std::nullopt);
  EXPECT_EQ(table.at(0), 0u);
  EXPECT_EQ(table.at(std::nextafter(10, 0)), 0u);
  EXPECT_EQ(table.at(10), 1u);
  EXPECT_EQ(table.at(1e30), 2u);
  EXPECT_EQ(Timetable{}.at(3), std::nullopt);
}

TEST(Timetable, RepeatsForwardsAndBackwards) {
  const Timetable table{{3, 4, 7}, 10};
  for (int cycle = -1000; cycle <= 1000; ++cycle)
    for (const auto& [t, row] : {std::pair{3.0, 0u}, {3.5, 0u}, {4.0, 1u}, {6.999, 1u}, {7.0, 2u}, {12.999, 2u}})
      EXPECT_EQ(table.at(t + 10.0 * cycle), row) << t << " " << cycle;
  // Whatever rounding does: a cycle begins where the row before it ends.
  const Timetable third{{0.1, 0.2}, 1.0 / 3};
  double t = 0;
  for (int k = 0; k < 300; ++k) {
    Rows rows = rows_over(third, t, t + 0.3);
    const auto [row, from, until] = rows.front();
    EXPECT_EQ(from, t);
    ASSERT_GT(until, t) << k;
    ASSERT_GE(rows.size(), 2u) << k;
    EXPECT_EQ(std::get<0>(rows[1]), 1 - row) << k;
    t = until;
  }
}

TEST(Timetable, ASpanVisitsEveryRowInIt) {
  const Timetable table{{0, 10, 12.5}};
  EXPECT_EQ(rows_over(table, -5, -1), (Rows{{-1, -5, -1}}));
  EXPECT_EQ(rows_over(table, -5, 11), (Rows{{-1, -5, 0}, {0, 0, 10}, {1, 10, 11}}));
  EXPECT_EQ(rows_over(table, 10, 10), (Rows{{1, 10, 10}}));
  // The end of a span belongs to it: what begins there holds there.
  EXPECT_EQ(rows_over(table, 4, 10), (Rows{{0, 4, 10}, {1, 10, 10}}));
  const double ever = std::numeric_limits<double>::infinity();
  EXPECT_EQ(rows_over(table, -ever, ever), (Rows{{-1, -ever, 0}, {0, 0, 10}, {1, 10, 12.5}, {2, 12.5, ever}}));
  const Timetable again{{3, 4}, 10};
  EXPECT_EQ(rows_over(again, 3.5, 13.2), (Rows{{0, 3.5, 4}, {1, 4, 13}, {0, 13, 13.2}}));
  EXPECT_EQ(rows_over(again, 0, 50), (Rows{{0, 0, 50}, {1, 0, 50}}));
}

TEST(Timetable, SaysWhatIsWrongWithIt) {
  using testing::HasSubstr;
  EXPECT_EQ((Timetable{{1, 2}, 5}.fault()), "");
  EXPECT_THAT((Timetable{{2, 2}}.fault()), HasSubstr("does not come after"));
  EXPECT_THAT((Timetable{{1, NAN}}.fault()), HasSubstr("not finite"));
  EXPECT_THAT((Timetable{{1, 6}, 5}.fault()), HasSubstr("period"));
  EXPECT_THAT((Timetable{{}, 5}.fault()), HasSubstr("period"));
  EXPECT_THAT((Timetable{{1}, -5}.fault()), HasSubstr("period"));
}

}  // namespace
}  // namespace suite::timetable_test
