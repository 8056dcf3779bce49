// Where the sun stands over one place on many days, quickly: for work on every row of a year.
//
// The exact sun (motion/ephemeris.h) once a day at the times asked about, its declination and equation of time linear
// in between: within 0.01 degree, half of that the sun's parallax. Without refraction.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "heat/weather_table.h"
#include "motion/ephemeris.h"

namespace suite {

class SunTable {
 public:
  // For times (s of the clock, ascending) and up to `before` s before each. Error: site (check_geodetic).
  SunTable(const Geodetic& site, const Clock& clock, std::span<const double> times, double before = 0);
  explicit SunTable(const WeatherTable& table);  // for all rows

  struct Place {
    double sine = 0;        // of the elevation
    double hour_angle = 0;  // rad, -pi to pi, 0 when the sun is highest
    double distance = 0;    // astronomical units
  };
  // Of a time within the days of the table.
  Place at(double t) const;
  // Mean over an interval of the sine of the elevation where the sun is up, by steps of 10 minutes or less.
  double mean_sine(double begin, double end) const;

 private:
  struct Day {
    int64_t day = 0;
    double declination = 0, longitude = 0, distance = 0;  // of the point below the sun when the day begins, rad
  };
  std::vector<Day> days_;
  double latitude_ = 0, longitude_ = 0;  // rad
};

}  // namespace suite
