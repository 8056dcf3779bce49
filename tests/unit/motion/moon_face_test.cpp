// Libration and eclipses, by published examples and catalogues.
#include "motion/moon_face.h"

#include <gtest/gtest.h>

#include "motion/ephemeris.h"

namespace suite::test::moon_face_test {
namespace {

// J. Meeus, "Astronomical Algorithms", example 53.a: 1992 April 12, 0 h TD, from the Earth's centre: libration -1.206
// and 4.194 degrees before the physical one; the Sun's colongitude is 22.11 degrees with it, so that the Sun stands at
// 67.89, and at a latitude of 1.46.
TEST(MoonFace, TheExampleOfMeeus) {
  const JulianDate tt{2448724.5, 0};
  const Instant instant = instant_from_utc(parse_iso8601("1992-04-11T23:59:00.816Z"));  // TT - UTC = 59.184 s
  const SceneFrame frame({0, 0, 0});
  const Vec3 centre = frame.enu_from_ecef({0, 0, 1});
  const SkyBody moon = moon_at(frame, centre, instant), sun = sun_at(frame, centre, instant);
  const Dir to_sun = normalized(sun.direction * sun.distance - moon.direction * moon.distance);
  const MoonFace face = moon_face(CelestialSphere(frame, tt, julian_ut1(instant, 0)), tt, moon.direction, to_sun);
  EXPECT_NEAR(face.longitude / kDegree, -1.206, 0.01);
  EXPECT_NEAR(face.latitude / kDegree, 4.194, 0.01);
  EXPECT_NEAR(face.sun_longitude / kDegree, 67.89, 0.06);
  EXPECT_NEAR(face.sun_latitude / kDegree, 1.46, 0.05);
}

// F. Espenak, "Catalog of lunar eclipses" (NASA): umbral and penumbral magnitudes at the greatest eclipse.
TEST(MoonFace, LunarEclipses) {
  const struct {
    const char* utc;
    double umbral, penumbral;
  } eclipses[] = {{"2025-03-14T06:58:43Z", 1.1784, 2.2595},
                  {"2026-08-28T04:12:59Z", 0.9299, 1.9645},
                  {"2024-09-18T02:44:18Z", 0.0849, 1.0372},
                  {"2024-03-25T07:12:51Z", -0.1325, 0.9577}};
  for (const auto& e : eclipses) {
    const LunarEclipse found = lunar_eclipse(instant_from_utc(parse_iso8601(e.utc)));
    EXPECT_NEAR(found.umbral, e.umbral, 0.02) << e.utc;
    EXPECT_NEAR(found.penumbral, e.penumbral, 0.02) << e.utc;
  }
  for (const char* none : {"2025-04-13T00:22:00Z", "2025-03-14T12:00:00Z", "2025-03-29T10:58:00Z"})
    EXPECT_LT(lunar_eclipse(instant_from_utc(parse_iso8601(none))).penumbral, 0) << none;
}

// 8 April 2024: total at Mazatlan about 18:09 UTC; nothing in Madrid. 14 October 2023: annular at Albuquerque, 16:36.
TEST(MoonFace, SolarEclipses) {
  const auto at = [](double latitude, double longitude, const char* utc) {
    return solar_eclipse(SceneFrame({latitude, longitude, 0}), {}, instant_from_utc(parse_iso8601(utc)));
  };
  EXPECT_GT(at(23.22, -106.42, "2024-04-08T18:09:30Z"), 1);
  EXPECT_LT(at(40.4, -3.7, "2024-04-08T18:09:30Z"), 0);
  EXPECT_NEAR(at(35.1, -106.6, "2023-10-14T16:36:00Z"), 0.97, 0.02);
  EXPECT_LT(at(23.22, -106.42, "2024-04-08T12:00:00Z"), 0);
}

}  // namespace
}  // namespace suite::test::moon_face_test
