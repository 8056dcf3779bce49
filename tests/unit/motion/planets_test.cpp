// Where planets stand, against astropy with JPL's DE421 (planets_reference.py), 1950 to 2049, from two places.
#include "motion/planets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace suite::test::planets_test {
namespace {

struct Row {
  int planet;
  double latitude, longitude, height, day, tt, ut1, azimuth, zenith, from_sun, from_earth, phase;
};
constexpr Row kRows[] = {
#include "tests/unit/motion/planets_rows.inc"
};
constexpr double kArcSecond = kDegree / 3600;
constexpr double kStated = 90 * kArcSecond;

CelestialSphere sphere_of(const Row& r) {
  return {SceneFrame({r.latitude, r.longitude, r.height}), {r.day, r.tt}, {r.day, r.ut1}};
}
Dir expected(const Row& r) { return dir_from_angles(r.zenith * kDegree, azimuth_from_compass_deg(r.azimuth)); }

// The theory's own bounds, by planet, seen from the Earth: 4 to 17 arc seconds of heliocentric longitude grow as the
// Earth is nearer than the Sun.
TEST(Planets, StandWhereAnotherTheorySeesThem) {
  double farthest[kPlanets] = {};
  for (const Row& r : kRows) {
    const CelestialSphere sphere = sphere_of(r);
    const PlanetPlace place = planet_place(static_cast<Planet>(r.planet), sphere, {r.day, r.tt});
    const double off = angle_between(sphere.without_air(place.place), expected(r));
    farthest[r.planet] = std::max(farthest[r.planet], off / kArcSecond);
    EXPECT_LT(off, kStated) << name_of(static_cast<Planet>(r.planet)) << " " << r.day + r.tt;
    // Centre of the Earth in the table: 4e-5 au.
    EXPECT_NEAR(length(place.from_sun), r.from_sun, 1e-3 * r.from_sun);
    EXPECT_NEAR(length(place.from_observer), r.from_earth, 1e-3 * r.from_sun + 5e-5);
    EXPECT_NEAR(place.phase_angle() / kDegree, r.phase, 0.03);
  }
  for (size_t i = 0; i < kPlanets; ++i) RecordProperty(name_of(static_cast<Planet>(i)), std::to_string(farthest[i]));
  for (const Planet inner : {Planet::mercury, Planet::venus, Planet::mars})
    EXPECT_LT(farthest[static_cast<size_t>(inner)], 45);
}

// Negative controls: without light time, or seen from the Sun's place in the sky of another day, the bounds break.
TEST(Planets, LightTimeAndTheDayAreNoticed) {
  double worst = 0;
  for (const Row& r : kRows) {
    const CelestialSphere sphere = sphere_of(r);
    const PlanetPlace place = planet_place(static_cast<Planet>(r.planet), sphere, {r.day, r.tt + 0.1});
    worst = std::max(worst, angle_between(sphere.without_air(place.place), expected(r)));
  }
  EXPECT_GT(worst, 4 * kStated);
}

// Far beyond the theory's years it still gives numbers.
TEST(Planets, AreFiniteInAnyYear) {
  for (const double day : {1e6, 2451544.5, 4e6}) {
    const CelestialSphere sphere(SceneFrame({0, 0, 0}), {day, 0}, {day, 0});
    for (size_t i = 0; i < kPlanets; ++i) {
      const PlanetPlace place = planet_place(static_cast<Planet>(i), sphere, {day, 0});
      EXPECT_TRUE(std::isfinite(place.place.right_ascension) && std::isfinite(place.place.declination)) << day;
    }
  }
}

}  // namespace
}  // namespace suite::test::planets_test
