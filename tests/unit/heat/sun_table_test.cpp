// The quick sun against the exact one.
#include "heat/sun_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"

namespace suite::sun_table_test {
namespace {

TEST(SunTable, AgreesWithTheEphemerisThroughAYear) {
  const Clock clock(parse_iso8601("2016-01-01T07:00:00Z"));
  std::vector<double> times;
  for (int i = 0; i < 366; ++i) times.push_back(86400.0 * i);
  Pcg32 random(3);
  for (const Geodetic& site : {Geodetic{39.83, -104.65, 1650}, Geodetic{-77.85, 166.67, 10}, Geodetic{0, 0, 0}}) {
    const SunTable table(site, clock, times);
    const SceneFrame frame(site);
    for (int i = 0; i < 300; ++i) {
      const double t = 366 * 86400 * random.uniform();
      const SkyBody sun = sun_at(frame, {}, clock.at(t));
      const SunTable::Place place = table.at(t);
      EXPECT_NEAR(std::asin(place.sine), sun.elevation, 0.007 * kDegree) << t;
      EXPECT_NEAR(place.distance, sun.distance / kAstronomicalUnit, 1e-4);
      // West of the meridian in the afternoon.
      if (std::abs(place.hour_angle) > 0.1 && std::abs(place.hour_angle) < 3) {
        EXPECT_EQ(place.hour_angle > 0, sun.direction.x < 0) << t;
      }
    }
  }
}

TEST(SunTable, MeanSineIsThatOfTheLitPart) {
  const Clock clock(parse_iso8601("2016-03-20T00:00:00Z"));
  const std::vector<double> times = {0, 86400};
  const SunTable table({0, 0, 0}, clock, times);
  // At the equator and the equinox a day of sin(elevation) has the mean 1/pi.
  EXPECT_NEAR(table.mean_sine(0, 86400), 1 / kPi, 1e-4);
  EXPECT_EQ(table.mean_sine(0, 3600), 0);
  EXPECT_NEAR(table.mean_sine(12 * 3600, 12 * 3600 + 60), 1, 2e-3);
}

}  // namespace
}  // namespace suite::sun_table_test
