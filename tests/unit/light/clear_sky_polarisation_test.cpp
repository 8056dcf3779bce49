// The clear sky polarises by Rayleigh's pattern.
#include <gtest/gtest.h>

#include <cmath>

#include "light/kinds/clear_sky.h"
#include "tests/support/conformance.h"

namespace suite::clear_sky_polarisation_test {
namespace {

using test::test_state;

// Across the plane of the sun, most at right angles from it, nothing towards it; what the sky is drawn and met with.
TEST(ClearSkies, PolariseAsMoleculesDo) {
  ClearSkySpec spec;
  spec.polarisation = 0.8;
  const Dir sun = dir_from_angles(50 * kDegree, 0.4);
  const Sky sky(clear_sky(spec, sun, Curve({0.3, 4}, {1800, 10}, Outside::error)).sky, test_state(2));
  const auto met = sky.met_outside({0, 0, 1}, 0);
  ASSERT_TRUE(met);
  ASSERT_NE(met->source, kUnpolarised);
  EXPECT_EQ(sky.sample({{0, 0, 0}, {}, true}, {0.3, 0.6, 0.2, 0.7}, 0)->source, met->source);
  const auto degree = [&](Dir d) {
    const Stokes s = sky.stokes(met->source, -d, 0);
    EXPECT_EQ(s[0], 1);
    EXPECT_EQ(s[3], 0);
    return std::hypot(s[1], s[2]);
  };
  EXPECT_NEAR(degree(sun), 0, 1e-12);
  EXPECT_NEAR(degree(dir_from_angles(40 * kDegree, 0.4 + kPi)), 0.8, 1e-12);
  const double c = sun.z;
  EXPECT_NEAR(degree({0, 0, 1}), 0.8 * (1 - c * c) / (1 + c * c), 1e-12);
  // In the plane of the sun and the zenith the field lies across it, along e2 of the meridian frame: Q < 0.
  EXPECT_LT(sky.stokes(met->source, -dir_from_angles(20 * kDegree, 0.4), 0)[1], -0.01);
  EXPECT_NEAR(sky.stokes(met->source, -dir_from_angles(20 * kDegree, 0.4), 0)[2], 0, 1e-12);
  // Less where dust scatters, by default.
  ClearSkySpec clean, dusty;
  clean.aerosol_depth_500 = 0.02, dusty.aerosol_depth_500 = 0.6;
  const Curve top({0.3, 4}, {1800, 10}, Outside::error);
  const double most = clear_sky(clean, sun, top).sky.polarisation->most;
  EXPECT_GT(most, 0.6);
  EXPECT_LT(most, 0.94);
  EXPECT_LT(clear_sky(dusty, sun, top).sky.polarisation->most, 0.5 * most);
}

// Tables of q and u, bilinear between rows and columns, around the circle.
TEST(SkyTables, ArePolarisedAsTheySay) {
  SkySpec spec;
  spec.radiance = Curve::constant(2);
  const Sky plain(spec, test_state(1));
  EXPECT_EQ(plain.met_outside({0, 0, 1}, 0)->source, kUnpolarised);
  spec.stokes = SkyStokes{{0, 0, 0, 0, 0.4, 0.2, 0, -0.2}, {0, 0, 0, 0, 0, 0.6, 0, 0}, 2, 4};
  const Sky sky(spec, test_state(1));
  const auto at = [&](double zenith, double azimuth) {
    return sky.stokes(sky.met_outside({0, 0, 1}, 0)->source, -dir_from_angles(zenith, azimuth), 0);
  };
  EXPECT_NEAR(at(kPi / 2, 0)[1], 0.4, 1e-9);
  EXPECT_NEAR(at(kPi / 4, kPi / 2)[1], 0.1, 1e-9);
  EXPECT_NEAR(at(kPi / 4, kPi / 2)[2], 0.3, 1e-9);
  EXPECT_NEAR(at(kPi / 2, kPi / 4)[1], 0.3, 1e-9);
  EXPECT_NEAR(at(kPi / 2, -kPi / 4)[1], 0.1, 1e-9) << "from the last column to the first";
  spec.stokes->q[0] = 1.2;
  EXPECT_THROW(Sky(spec, test_state(1)), Error);
}

}  // namespace
}  // namespace suite::clear_sky_polarisation_test
