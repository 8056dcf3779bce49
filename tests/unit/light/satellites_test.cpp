// Satellites in sunlight: the light of a matte sphere in closed form, the Earth's shadow, and their place by SGP4.
#include "light/night/satellites.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::test::satellites_test {
namespace {

const SceneFrame kFrame({0, 0, 0});
SunlitPoint standing(Vec3 place, Dir to_sun, double m2 = 2) {
  Pose pose;
  pose.translation = place;
  return SunlitPoint(static_track(pose), kFrame, to_sun, m2);
}

// At full phase a matte sphere of albedo a has the geometric albedo 2 a / 3: E = 2 a A / (3 pi d^2). At half phase the
// bracket is sin(pi / 2) = 1 in place of pi; at new phase 0.
TEST(Satellites, MatteSphere) {
  const double d = 500e3, full = 2.0 * 2 / (3 * kPi * d * d);
  // The Sun behind the observer who looks up: the Earth's shadow is not asked at the scene's zenith by day.
  const Vec3 up{0, 0, d};
  EXPECT_NEAR(standing({0, d, 1e3}, {0, -1, 1e-9}).share(0, {0, 0, 1e3}) / full, 1, 1e-8);
  EXPECT_NEAR(standing(up, {1, 0, 0}).share(0, {}) / full, 1 / kPi, 1e-8);
  EXPECT_NEAR(standing(up, {0, 0, 1}).share(0, {}) / full, 0, 1e-12);
  EXPECT_NEAR(standing({0, 0, 2 * d}, {1, 0, 0}).share(0, {}) / full, 0.25 / kPi, 1e-8) << "the inverse square";
}

// Straight over a place at midnight a satellite at 500 km is dark; with the Sun 10 degrees below the horizon it shines:
// the shadow's edge is R (1 / cos 10 - 1) = 98 km over the place.
TEST(Satellites, GoOutInTheShadow) {
  const auto seen = [](double height, double sun_deg) {
    const double a = sun_deg * kDegree;
    return standing({0, 0, height}, {std::cos(a), 0, std::sin(a)}).share(0, {});
  };
  EXPECT_EQ(seen(500e3, -90), 0);
  EXPECT_GT(seen(500e3, -10), 0);
  EXPECT_EQ(seen(80e3, -10), 0);
  EXPECT_GT(seen(120e3, -10), 0);
  EXPECT_EQ(seen(500e3, -30), 0) << "R (1 / cos 30 - 1) = 986 km";
}

}  // namespace
}  // namespace suite::test::satellites_test
