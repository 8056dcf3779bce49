// Domes of light over far cities: their shape and Walker's law in closed form.
#include "light/night/city_glow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/kinds/night_sky.h"
#include "spectral/photopic.h"

namespace suite::test::city_glow_test {
namespace {

Dir at(double elevation_deg, double azimuth_deg) {
  return dir_from_angles((90 - elevation_deg) * kDegree, azimuth_deg * kDegree);
}

TEST(CityGlow, FallsWithElevationAndAzimuth) {
  const CityGlow glow{170 * kDegree, 20 * kDegree, 15 * kDegree, Curve::constant(1)};
  EXPECT_NEAR(relative_glow(glow, at(0, 170)), 1, 1e-9);
  EXPECT_NEAR(relative_glow(glow, at(15, 170)), std::exp(-1), 1e-9);
  EXPECT_NEAR(relative_glow(glow, at(30, 190)), std::exp(-2.5), 1e-9);
  EXPECT_NEAR(relative_glow(glow, at(30, -170)), std::exp(-2.5), 1e-9);  // through 180 degrees
  EXPECT_EQ(relative_glow(glow, at(-1, 170)), 0);
}

// Walker's examples follow from 0.01 P d^-2.5: a town of 100 000 doubles the natural sky (V = 22, 1.7117e-4 cd/m2)
// from 15.85 km, and adds a tenth from 39.8 km.
TEST(CityGlow, WalkersLaw) {
  EXPECT_NEAR(walker_luminance(1e5, std::pow(1000, 0.4)), 1.7117e-4, 1e-7);
  EXPECT_NEAR(walker_luminance(1e5, std::pow(10000, 0.4)), 1.7117e-5, 1e-8);
}

// As a part of the sky it shines in its spectrum, scaled by the part, and changes nothing else.
TEST(NightMap, CityGlowIsAPart) {
  const Instant t = instant_from_utc(parse_iso8601("2026-01-10T23:00:00Z"));
  const CelestialSphere sphere(SceneFrame({49.4, 8.7, 120}), julian_tt(t), julian_ut1(t, 0));
  NightSkySpec spec;
  const NightMap dark(spec, sphere);
  spec.glows.push_back({0, 20 * kDegree, 15 * kDegree, Curve::constant(2e-6)});
  spec.scale[static_cast<size_t>(NightPart::city_glow)] = 3;
  const NightMap map(spec, sphere);
  ASSERT_EQ(map.components().size(), dark.components().size() + 1);
  EXPECT_EQ(map.first_point(), map.components().size());
  std::vector<double> w(map.components().size()), bare(dark.components().size());
  map.weights(at(15, 20), w);
  dark.weights(at(15, 20), bare);
  EXPECT_NEAR(w.back(), std::exp(-1.5), 1e-9);
  EXPECT_TRUE(std::equal(bare.begin(), bare.end(), w.begin()));
  EXPECT_NEAR(map.components().back().spectrum.mean(0.5, 0.6), 6e-6, 1e-12);
  const NightIlluminance lx = illuminance_of(map), without = illuminance_of(dark);
  // Integral over the plane: sine and cosine of the elevation times exp(-elevation / height), and a Gaussian.
  double ring = 0;
  for (int i = 0; i < 9000; ++i) {
    const double e = (i + 0.5) * 0.01 * kDegree;
    ring += 0.01 * kDegree * std::sin(e) * std::cos(e) * std::exp(-e / (15 * kDegree));
  }
  const double expected = 6e-6 * photopic(Curve::constant(1)) * ring * std::sqrt(2 * kPi) * 20 * kDegree;
  EXPECT_NEAR(lx.photopic[static_cast<size_t>(NightPart::city_glow)], expected, 1e-3 * expected);
  EXPECT_EQ(lx.photopic[0], without.photopic[0]);
}

}  // namespace
}  // namespace suite::test::city_glow_test
