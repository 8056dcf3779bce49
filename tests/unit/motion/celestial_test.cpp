// Where stars are seen, against values of astropy and pyerfa (celestial_reference.py), 1950 to 2100.
#include "motion/celestial.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::test::celestial_test {
namespace {

struct Row {
  double latitude, longitude, height, day, tt, ut1;
  int air;
  double right_ascension, declination, motion_right_ascension, motion_declination, azimuth, zenith;
};
constexpr Row kRows[] = {
#include "tests/unit/motion/celestial_rows.inc"
};
constexpr double kArcSecond = kDegree / 3600;

Dir expected(const Row& r) { return dir_from_angles(r.zenith * kDegree, azimuth_from_compass_deg(r.azimuth)); }
CatalogPlace star_of(const Row& r) {
  return {r.right_ascension * kDegree, r.declination * kDegree,
          r.motion_right_ascension * kArcSecond / std::cos(r.declination * kDegree), r.motion_declination * kArcSecond};
}
CelestialSphere sphere_of(const Row& r, double later_s = 0) {
  return {SceneFrame({r.latitude, r.longitude, r.height}),
          {r.day, r.tt},
          {r.day, r.ut1 + later_s / 86400},
          SurfaceAir{101325, 283, 0, 0.55}};
}

TEST(Celestial, StarsStandWhereAstropyAndErfaSeeThem) {
  int with_air = 0;
  double farthest = 0;
  for (const Row& r : kRows) {
    const CelestialSphere sphere = sphere_of(r);
    const Dir found = r.air ? sphere.seen(star_of(r)) : sphere.without_air(star_of(r));
    farthest = std::max(farthest, angle_between(found, expected(r)));
    with_air += r.air;
    EXPECT_LT(angle_between(found, expected(r)), 0.6 * kArcSecond) << r.day + r.tt << " " << r.declination;
  }
  EXPECT_GT(with_air, 10);
  std::printf("%zu places, farthest from astropy and ERFA %.2f arc seconds\n", std::size(kRows), farthest / kArcSecond);
  // A second of UT1 is 15 arc seconds of hour angle: noticed.
  EXPECT_GT(angle_between(sphere_of(kRows[0], 1).without_air(star_of(kRows[0])), expected(kRows[0])), 10 * kArcSecond);
}

TEST(Celestial, TurnsThereAndBack) {
  const CelestialSphere sphere = sphere_of(kRows[0]);
  const Dir d = normalized(Vec3{0.3, -0.5, 0.8});
  EXPECT_LT(length(sphere.to_celestial(sphere.to_scene(d)) - d), 1e-12);
  // The celestial pole stands at the latitude, within the precession of 50 years (1000 arc seconds).
  EXPECT_NEAR(std::asin(sphere.to_scene({0, 0, 1}).z) / kDegree, kRows[0].latitude, 0.3);
  EXPECT_LT(length(sphere.ecliptic().to_world({0, 0, 1}) - sphere.ecliptic().z), 1e-12);
}

// The Sun stands at longitude 0 at the March equinox of 2026 (20 March, 14:46 UTC; Meeus, "Astronomical Algorithms",
// chapter 27, gives it to a minute), and nearest in the first days of January.
TEST(Celestial, TheSunCrossesTheEquinox) {
  const auto at = [](const char* utc) {
    const Instant t = instant_from_utc(parse_iso8601(utc));
    return CelestialSphere(SceneFrame({0, 0, 0}), julian_tt(t), julian_ut1(t, 0));
  };
  EXPECT_NEAR(at("2026-03-20T14:46:00Z").sun_longitude() / kDegree, 0, 0.01);
  EXPECT_NEAR(at("2026-06-21T08:24:00Z").sun_longitude() / kDegree, 90, 0.01);
  EXPECT_NEAR(at("2026-01-03T17:00:00Z").sun_distance_au(), 0.98330, 1e-4);
}

}  // namespace
}  // namespace suite::test::celestial_test
