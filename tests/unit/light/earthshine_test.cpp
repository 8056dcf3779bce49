// Light of the new Moon.
#include <gtest/gtest.h>

#include "light/kinds/moon.h"
#include "light/kinds/solar_spectrum.h"

namespace suite::test::earthshine_test {
namespace {

MoonGeometry at_phase(double degrees) {
  MoonGeometry g;
  g.phase = g.sun_longitude = degrees * kDegree;
  return g;
}

// 8 lx of full Earth over 1.3e5 lx of the Sun: 6.15e-5 of the full Moon at new Moon, nothing at full Moon, and half as
// the phase function of a Lambertian sphere says (1 / pi at 90 degrees).
TEST(Earthshine, IsWhatTheEarthSends) {
  const Curve& sun = solar_irradiance();
  const double full = moon_irradiance(at_phase(1.5), sun).at(0.55);
  EXPECT_EQ(moon_irradiance(at_phase(180), sun).at(0.55), 0);
  EXPECT_NEAR(earthshine_irradiance(at_phase(180), sun).at(0.55) / full, 8 / 1.3e5, 1e-9);
  EXPECT_NEAR(earthshine_irradiance(at_phase(90), sun).at(0.55) / full, 8 / 1.3e5 / kPi, 1e-9);
  EXPECT_NEAR(earthshine_irradiance(at_phase(0), sun).at(0.55) / full, 0, 1e-9);
}

TEST(Earthshine, AddsToTheMoon) {
  MoonSpec moon;
  moon.geometry = at_phase(120);
  Scene scene;
  std::vector<std::string> said;
  const double without = resolved(moon, {scene, 0, 0, said}).disk.irradiance.at(0.55);
  moon.earthshine = true;
  const double with = resolved(moon, {scene, 0, 0, said}).disk.irradiance.at(0.55);
  EXPECT_NEAR(with - without, earthshine_irradiance(at_phase(120), solar_irradiance()).at(0.55), 1e-9 * with);
  EXPECT_GT(with, without);
}

}  // namespace
}  // namespace suite::test::earthshine_test
