// Calendar time, leap seconds, and texts of both.
#include "motion/time.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace suite::time_test {
namespace {

TEST(Time, SimulationSecondsRunThroughALeapSecond) {
  const Clock clock(parse_iso8601("2016-12-31T23:59:58Z"));
  EXPECT_EQ(clock.seconds(parse_iso8601("2016-12-31T23:59:60Z")), 2);
  EXPECT_EQ(clock.seconds(parse_iso8601("2017-01-01T00:00:00Z")), 3);
  EXPECT_EQ(to_iso8601(clock.utc(2.5), 1), "2016-12-31T23:59:60.5Z");
  EXPECT_EQ(to_iso8601(clock.utc(3.0), 0), "2017-01-01T00:00:00Z");
  EXPECT_EQ(to_iso8601(clock.utc(-86400), 0), "2016-12-30T23:59:58Z");
}

TEST(Time, TaiOffsetsOfTheBulletins) {
  // TAI - UTC: 10 s in 1972, 32 s in 2003, 37 s since 2017 (IERS Bulletin C).
  EXPECT_EQ(instant_from_utc({1972, 1, 1, 0, 0, 0}).seconds, 10);
  EXPECT_EQ(instant_from_utc({2003, 10, 17, 0, 0, 0}).seconds, 32);
  EXPECT_EQ(instant_from_utc({2026, 6, 1, 0, 0, 0}).seconds, 37);
}

TEST(Time, RoundTripThroughEveryKindOfDay) {
  for (const char* text : {"1972-01-01T00:00:00.000Z", "1972-06-30T23:59:60.250Z", "2000-02-29T12:00:00.000Z",
                           "2015-06-30T23:59:59.500Z", "2015-07-01T00:00:00.500Z", "2100-03-01T00:00:10.000Z"})
    EXPECT_EQ(to_iso8601(utc_from_instant(instant_from_utc(parse_iso8601(text)))), text);
}

TEST(Time, ZonesShiftTheCalendar) {
  EXPECT_EQ(to_iso8601(parse_iso8601("2003-10-17T12:30:30-07:00"), 0), "2003-10-17T19:30:30Z");
  EXPECT_EQ(to_iso8601(parse_iso8601("2004-03-01T00:30:00+0100"), 0), "2004-02-29T23:30:00Z");
  EXPECT_EQ(to_iso8601(parse_iso8601("2017-01-01T08:59:60+09:00"), 0), "2016-12-31T23:59:60Z");
  EXPECT_EQ(to_iso8601(parse_iso8601("2003-10-17"), 0), "2003-10-17T00:00:00Z");
  EXPECT_EQ(to_iso8601(parse_iso8601("2003-10-17 05:06"), 0), "2003-10-17T05:06:00Z");
}

TEST(Time, JulianDatesOfTheSpaExample) {
  const Instant i = instant_from_utc(parse_iso8601("2003-10-17T19:30:30Z"));
  const JulianDate ut1 = julian_ut1(i, 0), tt = julian_tt(i);
  EXPECT_NEAR((ut1.day - 2452930.0) + ut1.fraction, 0.312847, 5e-7);
  EXPECT_NEAR(((tt.day - ut1.day) + (tt.fraction - ut1.fraction)) * 86400, 64.184, 1e-6);
}

// Seconds far beyond the calendar are somebody's mistake, not ours: an Error, whoever asks.
TEST(Time, FarSecondsAreRefused) {
  const Clock clock(parse_iso8601("2026-06-21T10:00:00Z"));
  for (const double t : {1e11, 1e14, 1e18, 1e30, -1e14, -1e18}) {
    EXPECT_THROW(clock.utc(t), Error) << t;
    EXPECT_THROW(julian_ut1(clock.at(std::fabs(t) < 1e20 ? t : 1e19), 0), Error) << t;
  }
  EXPECT_THROW(clock.at(1e30), Error);
  EXPECT_NO_THROW(clock.utc(1e9));
}

TEST(Time, NamesWhatIsWrong) {
  for (const char* bad :
       {"", "2003", "2003-13-01", "2003-02-29", "2003-10-17T24:00:00Z", "2003-10-17T10:61:00Z", "2003-10-17T10:00:60Z",
        "2016-12-31T22:59:60Z", "2003-10-17T10:00:00.Z", "2003-10-17T10:00:00X", "2003-10-17T10:00:00+15:00",
        "1971-12-31", "2200-01-01", "2003-10-17T10:00:00Z ", "03-10-17", "2003/10/17", "2003-10-17T1:00"})
    EXPECT_THROW(parse_iso8601(bad), Error) << bad;
  EXPECT_THROW(instant_from_utc({2003, 1, 1, 0, 0, NAN}), Error);
  try {
    parse_iso8601("2003-10-17T19.30");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("expected ':' after the hour at character 14"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace suite::time_test
