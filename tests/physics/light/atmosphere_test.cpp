// The layered atmosphere against published optical depths, quadrature and conservation; the Earth against geometry.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "air/molecules.h"
#include "light/kinds/solar_spectrum.h"
#include "math/warps.h"
#include "optics/phase_function.h"
#include "spectral/planck.h"
#include "tests/support/message_of.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::atmosphere_test {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

SpectralState one_bin(double center_um) {
  return make_state(std::vector<Band>{Band::rectangular("b", center_um, 0.002)}, 1);
}
AtmosphereSpec hazy() {
  AtmosphereSpec s;
  AtmosphereSpec::Aerosol a;
  a.depth_550 = 0.3;
  a.phase.model = "hg";
  a.phase.numbers["g"] = 0.7;
  check_phase(a.phase);
  s.aerosol = a;
  s.gases.push_back({"ozone", Curve::constant(0.05), 20000, {}});
  return s;
}

TEST(Rayleigh, PublishedDepths) {
  // Against the independent formula of Hansen & Travis (Space Sci. Rev. 16, 1974, equation 2.30); pressure is a factor;
  // lambda^-4 beyond 1 um.
  for (double w = 0.32; w < 1; w += 0.04) {
    const double w2 = w * w, published = 0.008569 / (w2 * w2) * (1 + 0.0113 / w2 + 0.00013 / (w2 * w2));
    EXPECT_NEAR(rayleigh_depth(w, 101325) / published, 1, 0.01) << w;
  }
  EXPECT_NEAR(rayleigh_depth(0.55, 101325), 0.0971, 2e-4);
  EXPECT_NEAR(rayleigh_depth(0.55, 50000), rayleigh_depth(0.55, 101325) * 50000 / 101325, 1e-12);
  EXPECT_NEAR(rayleigh_depth(4, 101325) / rayleigh_depth(2, 101325), 1.0 / 16, 1e-9);
  EXPECT_NEAR(rayleigh_depth(1.0000001, 101325) / rayleigh_depth(0.9999999, 101325), 1, 1e-5);
}

TEST(StandardAir, TableOfTheStandard) {
  // U.S. Standard Atmosphere 1976, table I: 5 km 255.676 K 54048 Pa; 11 km 216.774 K 22699.9 Pa; 30 km 226.509 K 1197.0
  // Pa; 80 km 198.639 K 1.0524 Pa.
  const double table[][3] = {
      {5000, 255.676, 54048}, {11000, 216.774, 22699.9}, {30000, 226.509, 1197.0}, {80000, 198.639, 1.0524}};
  for (const auto& row : table) {
    EXPECT_NEAR(standard_air(row[0]).temperature, row[1], 0.01);
    EXPECT_NEAR(standard_air(row[0]).pressure / row[2], 1, 1e-3);
  }
}

TEST(Layered, TransmittanceIsTheClosedForm) {
  const AtmosphereSpec spec = hazy();
  const SpectralState state = one_bin(0.5);
  const auto air = make_layered_atmosphere(spec, state, {});
  const double depth = rayleigh_depth(0.5, 101325) + 0.3 * std::pow(0.5 / 0.55, -1.3) + 0.05;
  std::vector<float> T(1);
  for (const double zenith : {0.0, 60.0, 85.0}) {
    air->transmittance({5, -3, 0}, dir_from_angles(zenith * kDegree, 1), kFar, T);
    EXPECT_NEAR(T[0], std::exp(-depth / std::cos(zenith * kDegree)), 1e-5) << zenith;
    // From orbit down to the ground: the same air.
    const double slant = 700e3 / std::cos(zenith * kDegree);
    const Dir up = dir_from_angles(zenith * kDegree, 1);
    air->transmittance(up * slant, -up, slant, T);
    EXPECT_NEAR(T[0], std::exp(-depth / std::cos(zenith * kDegree)), 1e-5) << zenith;
  }
  // Nothing above the atmosphere; a gas that is not tabulated does not absorb.
  air->transmittance({0, 0, 1e5}, {0, 0, 1}, kFar, T);
  EXPECT_EQ(T[0], 1);
  AtmosphereSpec clear;
  clear.rayleigh = false;
  make_layered_atmosphere(clear, state, {})->transmittance({}, {0, 0, 1}, kFar, T);
  EXPECT_EQ(T[0], 1);
  // Along the horizon everything is absorbed in the end, and nothing is NaN.
  air->transmittance({0, 0, 10}, {1, 0, 0}, kFar, T);
  EXPECT_EQ(T[0], 0);
}

TEST(Layered, SegmentsCompose) {
  // Through a point on the way: T = T1 T2, S = S1 + T1 S2, for slanting paths up, down and level.
  const SpectralState state = one_bin(0.5);
  const std::vector<float> sun{1800};
  const auto air = make_layered_atmosphere(hazy(), state, {{dir_from_angles(0.7, 2), sun.data()}});
  std::vector<float> T(1), S(1), T1(1), S1(1), T2(1), S2(1);
  for (const Dir d : {dir_from_angles(0.3, 1), dir_from_angles(0.7, 2), dir_from_angles(1.5, 4),
                      dir_from_angles(2.2, 0), Dir{1, 0, 0}}) {
    const Vec3 from{100, 200, d.z < 0 ? 12345.0 : 50.0};
    air->path(from, d, 9000, T, S);
    air->path(from, d, 3456, T1, S1);
    air->path(from + d * 3456, d, 9000 - 3456, T2, S2);
    EXPECT_NEAR(T[0], T1[0] * T2[0], 2e-6);
    EXPECT_NEAR(S[0] / (S1[0] + T1[0] * S2[0]), 1, 3e-5);
    EXPECT_GT(S[0], 0);
  }
}

TEST(Layered, PathRadianceIsTheIntegral) {
  // Single scattering by midpoint quadrature of the defining integral in 20000 steps, with the transmittances of the
  // closed form; HG normalised over the sphere.
  const SpectralState state = one_bin(0.5);
  const std::vector<float> sun{1800};
  const Dir to_sun = dir_from_angles(0.9, 2);
  const AtmosphereSpec spec = hazy();
  const auto air = make_layered_atmosphere(spec, state, {{to_sun, sun.data()}});
  AtmosphereSpec only_aerosol = spec, only_air = spec;
  only_aerosol.rayleigh = false;
  only_aerosol.gases.clear();
  only_aerosol.aerosol->albedo = Curve::constant(1);
  only_air.aerosol.reset();
  only_air.gases.clear();
  const auto aerosol = make_layered_atmosphere(only_aerosol, state, {}),
             molecules = make_layered_atmosphere(only_air, state, {});
  const Vec3 from{0, 0, 20000};
  const Dir d = dir_from_angles(2.5, 1);
  const double length = 20000 / -d.z, g = 0.7, cosine = dot(to_sun, d), gamma = 0.0279 / (2 - 0.0279);
  const double hg = (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
  const double ray = 3 / (16 * kPi * (1 + 2 * gamma)) * (1 + 3 * gamma + (1 - gamma) * cosine * cosine);
  auto depth = [&](const Atmosphere& a, Vec3 p, Dir v, double l) {
    std::vector<float> T(1);
    a.transmittance(p, v, l, T);
    return -std::log(static_cast<double>(T[0]));
  };
  double sum = 0;
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    // Coefficients by differences of depth over a step within the layer.
    const double s = (i + 0.5) / n * length, step = length / n;
    const Vec3 p = from + d * s;
    const double ka = 0.95 * depth(*aerosol, p - d * (step / 2), d, step) / step,
                 kr = depth(*molecules, p - d * (step / 2), d, step) / step;
    sum += 1800 * (ka * hg + kr * ray) * std::exp(-depth(*air, from, d, s) - depth(*air, p, to_sun, kFar)) * step;
  }
  std::vector<float> T(1), S(1);
  air->path(from, d, length, T, S);
  EXPECT_NEAR(S[0] / sum, 1, 2e-3);
  EXPECT_GT(std::fabs(1.02 * S[0] / sum - 1), 2e-3);
}

TEST(Layered, IsothermalAirOverABlackFloorIsInvisible) {
  // Kirchhoff: an absorbing atmosphere at the ground's temperature changes nothing, at any depth and slant.
  Material ground = material("ground", lambert(0));
  ground.temperature_k = 300;
  const auto scene = scene_of({quad(1e5, 0, 0)}, {ground});
  const double B = planck_band_radiance(9.5, 10.5, 300);
  for (const double depth : {0.01, 1.0, 50.0}) {
    SourceSpecs s;
    s.atmosphere = AtmosphereSpec{};
    s.atmosphere->rayleigh = false;
    s.atmosphere->temperature_k.assign(s.atmosphere->heights.size() - 1, 300);
    s.atmosphere->gases.push_back({"vapour", Curve::constant(depth), 2000, {}});
    const auto run = render(scene, s,
                            std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 9000}, dir_from_angles(2.3, 1), 0},
                                                                         {{0, 0, 300e3}, {0, 0, -1}, 0}},
                                                        std::vector<Band>{Band::rectangular("lwir", 10, 1)}, 4, 2));
    for (const double L : run.result.radiance) EXPECT_NEAR(L / B, 1, 2e-5) << depth;
    // With colder air it does.
    s.atmosphere->temperature_k.assign(s.atmosphere->heights.size() - 1, 280);
    const auto cold = render(scene, s,
                             std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 9000}, dir_from_angles(2.3, 1), 0}},
                                                         std::vector<Band>{Band::rectangular("lwir", 10, 1)}, 4, 2));
    EXPECT_LT(cold.result.radiance[0] / B, 1 - 1e-3);
  }
}

TEST(Layered, SunlitFloorThroughTheAir) {
  // Seen from orbit: rho E mu / pi x T(sun) x T(view) + path radiance; the floor alone scatters, no sky.
  const auto scene = scene_of({quad(1e5, 0, 0)}, {material("floor", lambert(0.4))});
  SourceSpecs s;
  const Dir to_sun = dir_from_angles(0.5, 2);
  s.add(SunSpec{to_sun, 0, Curve::constant(1800)});
  s.atmosphere = hazy();
  PipelineOptions single;
  single.max_nodes = 1;  // the air lights the floor as well; here only the direct beam is wanted
  const auto run = render(scene, s,
                          std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 700e3}, {0, 0, -1}, 0}},
                                                      std::vector<Band>{Band::rectangular("b", 0.5, 0.002)}, 4, 1),
                          single);
  const std::vector<float> sun{1800};
  const auto air = make_layered_atmosphere(hazy(), one_bin(0.5), {{to_sun, sun.data()}});
  std::vector<float> T(1), S(1), down(1);
  air->path({0, 0, 700e3}, {0, 0, -1}, 700e3, T, S);
  air->transmittance({}, to_sun, kFar, down);
  EXPECT_NEAR(run.result.radiance[0], 0.4 / kPi * 1800 * to_sun.z * down[0] * T[0] + S[0],
              1e-4 * run.result.radiance[0]);
}

TEST(Layered, RefusesNonsense) {
  const SpectralState state = one_bin(0.5);
  auto message = [&](auto change) {
    AtmosphereSpec s = hazy();
    change(s);
    return message_of([&] { make_layered_atmosphere(s, state, {}); });
  };
  EXPECT_THAT(message([](auto& s) { s.heights = {0, 5, 5}; }), testing::HasSubstr("not ascending"));
  EXPECT_THAT(message([](auto& s) { s.heights = {0}; }), testing::HasSubstr("2 to 201"));
  EXPECT_THAT(message([](auto& s) { s.temperature_k = {3}; }), testing::HasSubstr("temperatures"));
  EXPECT_THAT(message([](auto& s) { s.gases[0].column = Curve::constant(-1); }),
              testing::HasSubstr("negative optical depth"));
  EXPECT_THAT(message([](auto& s) { s.aerosol->albedo = Curve::constant(1.1); }),
              testing::HasSubstr("between 0 and 1"));
}

TEST(Earth, NothingLeavesDownwards) {
  // A small scene above the ellipsoid, looked past from 700 km: every downward ray meets the Earth where geometry says,
  // every upward one the sky. A white Earth under a unit full-sphere sky shows no gap at all.
  auto scene = scene_of({quad(100, 0, 0)}, {material("quad", lambert(1)), material("soil", lambert(1))});
  scene->origin = {47, 11, 600, true};
  SourceSpecs s;
  s.earth = EarthSpec{"soil", 0.0, {}};
  const SceneFrame frame({47, 11, 600});
  std::vector<Ray> rays;
  for (int i = 0; i < 40; ++i) {
    const Vec3 target = frame.enu_from_geodetic({47 + 0.1 * (i - 20), 11 + 0.07 * i, 0}), from{1000, 2000, 700e3};
    rays.push_back({from, normalized(target - from), 0});
  }
  const Earth earth(frame, 0, 1);
  for (const Ray& r : rays) {
    const auto met = earth.meet(r.origin, r.direction, kFar);
    ASSERT_TRUE(met);
    EXPECT_NEAR(frame.geodetic_from_enu(met->position).height_m, 0, 1e-4);
    EXPECT_NEAR(dot(met->normal, frame.local_axes(met->position).z), 1, 1e-9);
  }
  // A horizon ray from 10 km above the ellipsoid dips by acos(a / (a + h)) before it meets it.
  const double dip = std::acos(6378137.0 / (6378137.0 + 10000));
  EXPECT_FALSE(earth.meet({0, 0, 9400}, dir_from_angles(kPi / 2 + 0.97 * dip, 0), kFar));
  EXPECT_TRUE(earth.meet({0, 0, 9400}, dir_from_angles(kPi / 2 + 1.03 * dip, 0), kFar));
  // From a pit below the ellipsoid: up is free, down is closed.
  EXPECT_FALSE(earth.meet({0, 0, -2000}, {0, 0, 1}, kFar));
  EXPECT_TRUE(earth.meet({0, 0, -2000}, {0, 0, -1}, kFar));
  s.add(uniform_sky(1, true));
  const auto run = render(scene, s, std::make_unique<RaySensor>(rays, one_band(), 64));
  for (const double L : run.result.radiance) EXPECT_NEAR(L, 1, 2e-2);
}

TEST(Earth, HidesTheSunAtNight) {
  auto scene = scene_of({quad(100, 0, 0)}, {material("quad", lambert(0.5, 0.5)), material("soil", lambert(0))});
  scene->origin = {0, 0, 0, true};
  SourceSpecs s;
  s.add(SunSpec{dir_from_angles(100 * kDegree, 0), 0, Curve::constant(1)});
  auto look = [] { return std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 10}, {0, 0, -1}, 0}}, one_band(), 4); };
  EXPECT_GT(render(scene, s, look()).result.radiance[0], 0)
      << "without an Earth the sun shines through the leaf from below";
  s.earth = EarthSpec{"soil", {}, {}};
  EXPECT_EQ(render(scene, s, look()).result.radiance[0], 0);
  s.earth->material = "soul";
  EXPECT_THAT(message_of([&] { render(scene, s, look()); }), testing::HasSubstr("did you mean 'soil'"));
}

}  // namespace
}  // namespace suite::test::atmosphere_test
