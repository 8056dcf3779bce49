// Time: calendar UTC with leap seconds, uniform time (TAI), and the seconds a simulation counts.
//
// Assumes: UTC from 1972 on (whole leap seconds). After the last leap second that ERFA's table knows, none is added.
// Simulation time is SI seconds after an epoch, so it runs through leap seconds without a step.
// Based on: IERS Conventions 2010 (IERS TN 36), chapter 10; SOFA "Time Scale and Calendar Tools"; ISO 8601-1:2019.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "motion/time_span.h"

namespace suite {

// A calendar date and time in UTC. second is below 60, or below 61 in the minute of a leap second.
struct Utc {
  int year = 2000, month = 1, day = 1, hour = 0, minute = 0;
  double second = 0;
};

// A point on the uniform time scale TAI: modified Julian day and the seconds of that day, 0 <= seconds < 86400.
struct Instant {
  int64_t day = 0;
  double seconds = 0;
};
Instant operator+(Instant instant, double seconds);
double operator-(Instant a, Instant b);  // s

// Error: no such date or time (month 13, 30 February, second 60 outside a leap second), a year outside 1972..2199.
Instant instant_from_utc(const Utc& utc);
Utc utc_from_instant(Instant instant);  // Error outside 1972..2199

// "2003-10-17T19:30:30.5Z", "2003-10-17 12:30:30-07:00", "2003-10-17"; no zone means UTC. Error says what is wrong.
Utc parse_iso8601(std::string_view text);
// With `decimals` (0..9) digits of the second, cut (not rounded, which could make a 60th second), and a final Z.
std::string to_iso8601(const Utc& utc, int decimals = 3);

// Two-part Julian dates as the astronomical routines take them: day + fraction.
struct JulianDate {
  double day = 0, fraction = 0;
};
JulianDate julian_tt(Instant instant);  // terrestrial time, TAI + 32.184 s
// UT1 = UTC + dut1 (s, as published by the IERS; |dut1| < 0.9 by definition of UTC).
JulianDate julian_ut1(Instant instant, double dut1);

// The clock of a simulation: second 0 is the epoch.
class Clock {
 public:
  explicit Clock(const Utc& epoch) : epoch_(instant_from_utc(epoch)) {}
  Instant at(double t) const { return epoch_ + t; }
  double seconds(Instant instant) const { return instant - epoch_; }
  double seconds(const Utc& utc) const { return instant_from_utc(utc) - epoch_; }
  Utc utc(double t) const { return utc_from_instant(at(t)); }

 private:
  Instant epoch_;
};

}  // namespace suite
