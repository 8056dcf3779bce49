// Sun, Moon, clear and thermal skies, atmosphere and Earth against published values and closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "light/kinds/clear_sky.h"
#include "light/kinds/moon.h"
#include "light/kinds/solar_spectrum.h"
#include "motion/ephemeris.h"
#include "motion/time.h"
#include "spectral/planck.h"
#include "tests/support/message_of.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::sources_test {
namespace {

// ASTM G173-03: columns wavelength nm, extraterrestrial, global tilt, direct and circumsolar, W/(m2 nm).
struct G173 {
  Curve top, direct;
};
G173 read_g173() {
  std::ifstream in(SUITE_TEST_DATA "/solar/ASTMG173.csv");
  std::vector<double> x, top, direct;
  for (std::string line; std::getline(in, line);) {
    double w, a, b, c;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &w, &a, &b, &c) != 4) continue;
    x.push_back(w * 1e-3), top.push_back(a * 1e3), direct.push_back(c * 1e3);
  }
  return {Curve(x, top, Outside::error), Curve(x, direct, Outside::error)};
}

TEST(SolarSpectrum, Integrals) {
  // Total solar irradiance 1361 W/m2 (Kopp & Lean 2011); the reference spectrum itself from 0.202 to 2.73 um holds
  // 1327.0 W/m2; the blackbody tail follows the brightness temperature of the join.
  const Curve& sun = solar_irradiance();
  EXPECT_NEAR(sun.integral(0.202, 2.725), 1327, 1.5);
  EXPECT_NEAR(sun.integral(0.202, 1000), 1361, 5);
  EXPECT_NEAR(sun.at(0.55), 1870, 60);
  EXPECT_NEAR(sun.at(10) / sun.at(20), planck_radiance(10, 5772) / planck_radiance(20, 5772), 1e-3 * 16);
  EXPECT_THAT(message_of([&] { sun.at(0.15); }), testing::HasSubstr("was asked at 0.15"));
}

TEST(ClearSky, DirectBeamOfTheStandardAtmosphere) {
  // The table's atmosphere: air mass 1.5, water 1.42 cm, ozone 0.34 atm-cm, aerosol depth 0.084 at 0.5 um, 1013.25 hPa.
  // Band integrals of the direct beam within 5 %, from the table's own extraterrestrial spectrum.
  const G173 g173 = read_g173();
  const Dir sun = dir_from_angles(48.19 * kDegree, 1);
  EXPECT_NEAR(air_mass(48.19 * kDegree), 1.5, 0.005);
  ClearSkySpec spec;
  spec.ozone_cm = 0.34;
  const ClearSky sky = clear_sky(spec, sun, g173.top);
  const double bands[][2] = {{0.30, 0.4}, {0.4, 0.5}, {0.5, 0.6}, {0.6, 0.7}, {0.7, 0.9},
                             {0.9, 1.1},  {1.1, 1.4}, {1.5, 1.8}, {2, 2.5},   {0.3, 4}};
  for (const auto& b : bands) {
    const double got = sky.direct.integral(b[0], b[1]), truth = g173.direct.integral(b[0], b[1]);
    EXPECT_NEAR(got / truth, 1, 0.05) << b[0] << " to " << b[1] << " um";
  }
  EXPECT_NEAR(sky.direct.integral(0.3, 4), 900.1, 0.05 * 900.1);
  // A hazy atmosphere is another one.
  spec.aerosol_depth_500 = 0.3;
  EXPECT_GT(std::fabs(clear_sky(spec, sun, g173.top).direct.integral(0.3, 4) / 900.1 - 1), 0.05);
}

TEST(ClearSky, RadianceClosesToTheDiffuseIrradiance) {
  // A white floor under the sky alone reflects E / pi: closure to 0.1 % for high and low suns, clear and hazy. With the
  // sky 0.2 % brighter the same comparison fails.
  for (const double zenith : {10.0, 48.0, 80.0})
    for (const double depth : {0.02, 0.6}) {
      ClearSkySpec spec;
      spec.aerosol_depth_500 = depth;
      const Dir sun = dir_from_angles(zenith * kDegree, 2);
      const ClearSky clear = clear_sky(spec, sun, solar_irradiance());
      const std::vector<Band> bands{Band::rectangular("a", 0.455, 0.01), Band::rectangular("b", 0.875, 0.01)};
      const Sky sky(clear.sky, make_state(bands, 0.01));
      std::vector<float> L(2);
      double sum[2] = {0, 0};
      const int rows = 720, columns = 1440;
      for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
          const double theta = (r + 0.5) / rows * kPi / 2;
          std::fill(L.begin(), L.end(), 0.0f);
          sky.add(dir_from_angles(theta, (c + 0.5) / columns * 2 * kPi), 0, 1, L);
          for (int b = 0; b < 2; ++b)
            sum[b] +=
                L[static_cast<size_t>(b)] * std::cos(theta) * std::sin(theta) * (kPi / 2 / rows) * (2 * kPi / columns);
        }
      for (int b = 0; b < 2; ++b) {
        const double truth =
            clear.diffuse.mean(bands[static_cast<size_t>(b)].low_um(), bands[static_cast<size_t>(b)].high_um());
        EXPECT_NEAR(sum[b] / truth, 1, 1e-3) << zenith << " " << depth;
        EXPECT_GT(std::fabs(1.002 * sum[b] / truth - 1), 1e-3);
      }
      // The circumsolar region outshines the rest of a clear sky, and the horizon opposite a high sun its zenith.
      EXPECT_GT(sky.relative(sun), sky.relative(dir_from_angles(zenith * kDegree, 2 + kPi)));
    }
}

TEST(Moon, PublishedReflectance) {
  // Equation 10 worked out by hand at 544 nm for a phase of 7 degrees without libration:
  // ln A = -2.13864 - 1.60613 g + 0.27886 g^2 - 0.16426 g^3 + (sun longitude = g) 0.03833 g + 0.01189 g^3 - 0.0039 g^5
  //        + 0.3719 exp(-7 / 4.06054) - 0.10629 exp(-7 / 12.8802) + 0.01428 cos(37.5858 / 16.7498).
  MoonGeometry g;
  g.phase = g.sun_longitude = 7 * kDegree;
  EXPECT_NEAR(moon_reflectance(g).at(0.544), 0.097238, 2e-6);
  // The Moon reddens, and fades by a factor of about ten from full to half.
  EXPECT_GT(moon_reflectance(g).at(0.8653), 1.3 * moon_reflectance(g).at(0.4416));
  MoonGeometry half = g;
  half.phase = half.sun_longitude = kPi / 2;
  const double fade = moon_reflectance(g).at(0.5491) / moon_reflectance(half).at(0.5491);
  EXPECT_GT(fade, 7);
  EXPECT_LT(fade, 13);
  // Irradiance: 2.7 uW/(m2 nm) at 550 nm near full Moon within 15 % (Velikodsky et al. 2011 give 2.5 to 3); inverse
  // squares.
  const double e = moon_irradiance(g, solar_irradiance()).at(0.55);
  EXPECT_NEAR(e, 2.7e-3 * 1.4, 0.6e-3);
  MoonGeometry far = g;
  far.observer_distance *= 1.1, far.sun_distance_au = 1.02;
  EXPECT_NEAR(moon_irradiance(far, solar_irradiance()).at(0.55), e / (1.21 * 1.0404), 1e-9);
}

TEST(Moon, FollowsTheDate) {
  auto scene = scene_of({quad(5, 0, 0)}, {material("m", lambert(0.5))});
  scene->origin = {45, 8, 300, true};
  MoonSpec written;
  written.disk.time = SourceTime{"2026-03-03T22:00:00Z", {}};  // a night of full moon (eclipse at 11:33 UTC that day)
  written.disk.disk_by_time = true;
  std::vector<std::string> said;
  const MoonSpec moon = resolved(written, {*scene, 0, 0, said});
  ASSERT_EQ(said.size(), 1u);
  EXPECT_LT(moon.geometry.phase, 8 * kDegree);
  EXPECT_GT(moon.disk.direction.z, 0);
  EXPECT_NEAR(moon.disk.half_angle, 0.26 * kDegree, 0.025 * kDegree);
  EXPECT_LT(moon.geometry.sun_longitude, 0) << "waning";
  SunSpec dated;
  dated.irradiance = solar_irradiance();
  dated.at_1_au = true;
  dated.time = SourceTime{"2026-01-04T11:00:00Z", {}};
  SourceSpecs sun, nowhere;
  sun.add(dated), nowhere.add(dated);
  resolve_sources(sun, *scene);
  EXPECT_NEAR(sun.sun()->disk()->irradiance.at(0.55) / solar_irradiance().at(0.55), 1.034, 5e-4)
      << "at perihelion, 0.9833 AU";
  scene->origin.given = false;
  EXPECT_THAT(message_of([&] { resolve_sources(nowhere, *scene); }), testing::HasSubstr("geodetic origin"));
}

TEST(ThermalSky, LayersOfAir) {
  // One layer at 280 K of depth 0.4: L(theta) = B (1 - exp(-0.4 / cos)); two layers: Schwarzschild by hand; a black one
  // hides what lies above; the horizon is black.
  SkySpec spec;
  spec.zeniths = 91;
  spec.layers = {{280, Curve::constant(0.4)}, {220, Curve::constant(0.7)}};
  const SpectralState state = make_state(std::vector<Band>{Band::rectangular("lwir", 10, 0.1)}, 1);
  const double warm = planck_band_radiance(9.95, 10.05, 280) / 0.1, cold = planck_band_radiance(9.95, 10.05, 220) / 0.1;
  const Sky sky(spec, state);
  for (const double degrees : {0.0, 30.0, 60.0, 85.0, 90.0}) {
    const double c = std::cos(degrees * kDegree), T = degrees == 90 ? 0 : std::exp(-0.4 / c),
                 U = degrees == 90 ? 0 : std::exp(-0.7 / c);
    std::vector<float> L(1, 0.0f);
    sky.add(dir_from_angles(degrees * kDegree, 1), 0, 1, L);
    EXPECT_NEAR(L[0], warm * (1 - T) + T * cold * (1 - U), 1e-5 * warm) << degrees;
  }
  spec.layers.front().optical_depth = Curve::constant(100);
  std::vector<float> L(1, 0.0f);
  Sky(spec, state).add({0, 0, 1}, 0, 1, L);
  EXPECT_NEAR(L[0], warm, 1e-6 * warm);
}

}  // namespace
}  // namespace suite::test::sources_test
