// Sun and Moon against published worked examples.
#include "motion/ephemeris.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "base/error.h"

namespace suite::ephemeris_test {
namespace {

// The rows "name,value,unit,note" of the solar position example.
std::map<std::string, double> spa_example() {
  std::ifstream in(SUITE_TEST_DATA "/motion/spa_reference.csv");
  std::map<std::string, double> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    std::string name, value;
    std::getline(cells, name, ',');
    std::getline(cells, value, ',');
    if (name != "quantity" && name != "input_utc") rows[name] = std::stod(value);
  }
  return rows;
}

double compass_deg(Dir d) {
  const double a = std::atan2(d.x, d.y) / kDegree;
  return a < 0 ? a + 360 : a;
}

TEST(Ephemeris, SunOfTheSolarPositionExample) {
  const auto ref = spa_example();
  const SceneFrame frame({ref.at("input_latitude"), ref.at("input_longitude"), ref.at("input_elevation")});
  const Instant when = instant_from_utc(parse_iso8601("2003-10-17T19:30:30Z"));
  const SkyBody sun = sun_at(frame, {}, when);
  EXPECT_NEAR(sun.elevation / kDegree, ref.at("e0_elevation_no_refraction"), 5e-4);
  EXPECT_NEAR(compass_deg(sun.direction), ref.at("Phi_azimuth_from_north"), 5e-4);
  EXPECT_NEAR(sun.distance / kAstronomicalUnit, ref.at("R_sun_distance"), 1e-4);  // from the ground, not the centre
  std::printf("Sun: elevation differs by %.6f deg, azimuth by %.6f deg\n",
              sun.elevation / kDegree - ref.at("e0_elevation_no_refraction"),
              compass_deg(sun.direction) - ref.at("Phi_azimuth_from_north"));

  const SkyBody lifted =
      sun_at(frame, {}, when, 0, {ref.at("input_pressure") * 100, ref.at("input_temperature") + 273});
  EXPECT_NEAR(lifted.elevation / kDegree, ref.at("e_elevation"), 5e-4);
  EXPECT_NEAR((lifted.elevation - sun.elevation) / kDegree, ref.at("de_refraction"), 2e-5);
  EXPECT_NEAR(compass_deg(lifted.direction), compass_deg(sun.direction), 1e-9);
  EXPECT_NEAR(polar_angle(lifted.direction) / kDegree, 90 - lifted.elevation / kDegree, 1e-9);
}

// J. Meeus, Astronomical Algorithms, 2nd ed., example 47.a: 1992 April 12, 0h TD; apparent place and distance.
TEST(Ephemeris, MoonOfMeeusExample) {
  // 0h terrestrial time is 32.184 s earlier on the TAI scale.
  const Instant when = Instant{48724, 0} + -32.184;
  const EquatorialPlace moon = moon_geocentric(when);
  std::printf("Moon: right ascension differs by %.6f deg, declination by %.6f deg, distance by %.1f km\n",
              moon.right_ascension / kDegree - 134.688470, moon.declination / kDegree - 13.768368,
              moon.distance / 1000 - 368409.7);
  EXPECT_NEAR(moon.right_ascension / kDegree, 134.688470, 3e-3);
  EXPECT_NEAR(moon.declination / kDegree, 13.768368, 3e-3);
  EXPECT_NEAR(moon.distance, 368409.7e3, 20e3);
  // Example 48.a: phase angle i = 69.0756 degrees.
  EXPECT_NEAR(moon_phase_angle(when) / kDegree, 69.0756, 0.01);
}

// Seen from the ground the Moon is displaced by up to its parallax of about a degree; the displacement is downwards.
TEST(Ephemeris, MoonParallaxLowersTheMoon) {
  const SceneFrame ground({40, 0, 0});
  const Instant when = instant_from_utc(parse_iso8601("2024-03-20T20:00:00Z"));
  const SkyBody near = moon_at(ground, {}, when);
  // The same direction from the Earth's centre: a site there, expressed in the scene's frame.
  const SkyBody centre = moon_at(ground, ground.enu_from_ecef({0, 0, 1}), when);
  const double lowered = std::asin(centre.direction.z) - std::asin(near.direction.z);
  const double parallax = std::asin(6369.3e3 / centre.distance * std::cos(std::asin(near.direction.z)));
  EXPECT_NEAR(lowered, parallax, 0.01 * parallax);
  EXPECT_NEAR(near.angular_radius / kDegree, 0.26, 0.02);
}

// The turning Earth carries the observer eastward at w r cos(latitude), 465 m/s at the equator: what stands above is
// seen w r / c = 1.5515e-6 rad (0.32") further east than its parallax leaves it (Explanatory Supplement to the
// Astronomical Almanac, 1992, section 3.25). A site at the Earth's centre has neither.
TEST(Ephemeris, TheTurningEarthMovesTheSunEast) {
  const SceneFrame frame({0, 0, 0});
  const Instant noon = instant_from_utc(parse_iso8601("2024-03-20T12:07:30Z"));
  const Vec3 centre_site = frame.enu_from_ecef({0, 0, 0});
  const SkyBody centre = sun_at(frame, centre_site, noon), ground = sun_at(frame, {}, noon);
  ASSERT_GT(ground.direction.z, 0.999);
  const Dir by_parallax = normalized(centre_site + centre.direction * centre.distance);
  EXPECT_NEAR(ground.direction.x - by_parallax.x, 7.292115e-5 * 6378137 / 299792458, 1e-9);
  EXPECT_NEAR(ground.direction.y - by_parallax.y, 0, 1e-9);
}

// The 2024 April 8 eclipse was total at Mazatlan (23.2 N 106.4 W) around 18:09:30 UTC: the disks must nearly coincide.
TEST(Ephemeris, SunAndMoonMeetInTheEclipse) {
  const SceneFrame frame({23.2, -106.42, 10});
  const Instant when = instant_from_utc(parse_iso8601("2024-04-08T18:09:30Z"));
  const SkyBody sun = sun_at(frame, {}, when), moon = moon_at(frame, {}, when);
  EXPECT_LT(angle_between(sun.direction, moon.direction), moon.angular_radius - sun.angular_radius + 0.01 * kDegree);
  EXPECT_GT(moon.angular_radius, sun.angular_radius);
}

TEST(Ephemeris, SunRadiusAndSeason) {
  const SceneFrame frame({0, 0, 0});
  const SkyBody perihelion = sun_at(frame, {}, instant_from_utc({2024, 1, 3, 12, 0, 0}));
  const SkyBody aphelion = sun_at(frame, {}, instant_from_utc({2024, 7, 5, 12, 0, 0}));
  EXPECT_NEAR(perihelion.angular_radius / kDegree, 0.2711, 2e-4);
  EXPECT_NEAR(aphelion.angular_radius / kDegree, 0.2622, 2e-4);
}

TEST(Ephemeris, RefractionNearTheHorizonAndBelow) {
  const SiteAir air{101000, 283};
  EXPECT_NEAR(refraction_lift(0, air) / kDegree * 60, 28.98, 0.1);  // Saemundsson at geometric 0
  EXPECT_EQ(refraction_lift(-0.02, air), 0);
  EXPECT_NEAR(refraction_lift(kPi / 2, air), 0, 1e-6);
  EXPECT_GE(refraction_lift(kPi / 2, air), 0);
  EXPECT_EQ(refraction_lift(0.1, {}), 0);
}

TEST(Ephemeris, RefusesImpossibleAir) {
  const SceneFrame frame({0, 0, 0});
  const Instant when = instant_from_utc({2024, 1, 1, 0, 0, 0});
  EXPECT_THROW(sun_at(frame, {}, when, 0, {-1, 283}), Error);
  EXPECT_THROW(sun_at(frame, {}, when, 0, {1e5, 0}), Error);
  // Texts are held to 0.9 s; here it may grow by one at each leap second of a run (motion/ut1.h).
  EXPECT_THROW(moon_at(frame, {}, when, 4.5), Error);
  EXPECT_NO_THROW(moon_at(frame, {}, when, 1.5));
}

// Interpolated between knots of three hours: instants of all phases of a knot, of 150 years, in any order.
TEST(Ephemeris, TheSeriesOfTheSunIsTheExactOne) {
  const SceneFrame frame({49.4, 8.7, 100});
  const Vec3 site{100, -50, 20};
  const SunSeries series(frame, site);
  double worst = 0, distance = 0, moved = 0;
  for (int i = 0; i < 200; ++i) {
    const int year = 1975 + (37 * i) % 150;
    const Instant when = instant_from_utc(parse_iso8601(
        strf("%d-%02d-%02dT%02d:%02d:%02dZ", year, 1 + i % 12, 1 + (7 * i) % 28, (5 * i) % 24, (13 * i) % 60, i % 60)));
    const SkyBody exact = sun_at(frame, site, when, 0.1, {101325, 280}), found = series.at(when, 0.1, {101325, 280});
    worst = std::max(worst, length(found.direction - exact.direction));
    distance = std::max(distance, std::fabs(found.distance / exact.distance - 1));
    moved = std::max(moved, length(sun_at(frame, site, when, 0.1001, {101325, 280}).direction - exact.direction));
  }
  std::printf("series of the sun: %.2g rad, %.2g of its distance\n", worst, distance);
  EXPECT_LT(worst, 1e-9);
  EXPECT_LT(distance, 1e-9);
  EXPECT_GT(moved, 5e-9);  // control: 0.1 ms of the Earth's rotation is seen
  EXPECT_THROW(series.at(instant_from_utc(parse_iso8601("2020-01-01T00:00:00Z")), 10), Error);
}

}  // namespace
}  // namespace suite::ephemeris_test
