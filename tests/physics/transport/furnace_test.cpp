// Furnaces and closed forms of the radiometry core.
//
// Open furnace: a convex body in a uniform field of radiance L0 returns W(out) L0, for every model of the table, knot
// and direction. Closed furnace: an isothermal box returns B(T). One-surface closed forms: a Lambert plane under the
// sun.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "math/stats.h"
#include "spectral/planck.h"
#include "tests/support/model_examples.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::furnace_test {
namespace {

// Rays onto the middle of a horizontal square, from above and (for transmitters) from below.
std::vector<Ray> rays_onto_square(const std::vector<double>& zeniths) {
  std::vector<Ray> rays;
  for (const double zenith : zeniths) {
    const Dir out = dir_from_angles(zenith, 0.7);
    rays.push_back({out * 10.0, -out, 0});
  }
  return rays;
}

struct ModelCase {
  std::string row;
  size_t example;
};
std::vector<ModelCase> all_models() {
  std::vector<ModelCase> cases;
  for (const ModelRow& row : models())
    for (size_t e = 0; e < row.examples().size(); ++e) cases.push_back({row.name, e});
  return cases;
}

// As many as the bound of the standard error needs: more where weights vary more.
uint32_t paths_of(const std::string& row) {
  if (row == "ggx_dielectric" || row == "coated") return 1 << 16;
  if (row == "ward" || row == "sqt") return 1 << 15;
  return row == "sea" ? 1 << 14 : 1 << 13;
}

class OpenFurnace : public testing::TestWithParam<ModelCase> {};

TEST_P(OpenFurnace, ConvexBodyReturnsItsTotal) {
  ModelSpec spec = test::examples_of(models().find(GetParam().row))[GetParam().example];
  const auto scene = scene_of({quad(1, 0, 0)}, {material("m", spec)});
  const std::vector<double> zeniths{0.05, 0.5, 1.0, 1.3, kPi - 0.6};
  std::vector<Band> bands;
  for (const double c : {0.45, 0.65, 0.85}) bands.push_back(Band::rectangular("b" + std::to_string(c), c, 0.01));
  SourceSpecs sources;
  sources.add(uniform_sky(2, true));
  const uint32_t paths = paths_of(GetParam().row);
  const auto run = render(scene, sources, std::make_unique<RaySensor>(rays_onto_square(zeniths), bands, paths));
  // The reference is the model's own total, whose truth the conformance tests establish.
  const SpectralState state = make_state(bands, 0.01);
  const auto model = bake(scene->materials[0].surface, state);
  const BandProjection projection(state, bands);
  std::vector<float> W(state.size());
  std::vector<double> in_bands(bands.size());
  for (size_t i = 0; i < zeniths.size(); ++i) {
    model->total(dir_from_angles(zeniths[i], 0.7), W);
    projection.apply(std::vector<double>(W.begin(), W.end()), in_bands);
    for (size_t b = 0; b < bands.size(); ++b) {
      const double expected = 2.0 * in_bands[b], got = run.result.radiance[i * bands.size() + b],
                   se = run.result.standard_error[i * bands.size() + b];
      // 0.1 % of the value; the 5-sigma term covers models whose sampling weights vary.
      EXPECT_NEAR(got, expected, 1e-3 * expected + 5 * se + 1e-9) << "zenith " << zeniths[i] << " band " << b;
      // A dispersive interface carries each wavelength on one knot's paths only: most paths then bring nothing.
      const double share = model->has_delta() && !model->spectrally_uniform_shape() ? 10 : 1;
      EXPECT_LE(se, share * 5e-3 * expected + 1e-4)
          << "sampling weights vary too much for the furnace to mean anything";
    }
  }
  EXPECT_EQ(run.report.statistics.failures, 0u);
}
INSTANTIATE_TEST_SUITE_P(Table, OpenFurnace, testing::ValuesIn(all_models()),
                         [](const auto& one) { return one.param.row + "_" + std::to_string(one.param.example); });

// A rough pane lost up to 61 % of the light: what met more than one facet.
TEST(OpenFurnaces, RoughPaneReturnsAll) {
  for (const double roughness : {0.1, 0.6}) {
    const ModelSpec spec{"ggx_dielectric", {{"roughness", roughness}}, {{"index", Curve::constant(1.5)}}, {}, nullptr};
    const auto scene = scene_of({box({-5, -5, -0.01}, {5, 5, 0}, 0, true)}, {material("pane", spec)});
    SourceSpecs sources;
    sources.add(uniform_sky(2, true));
    const std::vector<double> zeniths{0, 63 * kDegree};
    const auto run = render(scene, sources, std::make_unique<RaySensor>(rays_onto_square(zeniths), one_band(), 1 << 15),
                            PipelineOptions{});
    for (size_t i = 0; i < zeniths.size(); ++i) {
      EXPECT_NEAR(run.result.radiance[i], 2, 3e-3 * 2 + 4 * run.result.standard_error[i]) << roughness << ' ' << i;
      EXPECT_LT(run.result.standard_error[i], 0.02) << roughness << ' ' << i;
    }
  }
}

TEST(ClosedFurnace, IsothermalBoxIsBlack) {
  // A camera inside a closed box of emissivity 0.3 at 300 K sees the blackbody, short of what max_nodes cuts:
  // (1 - e)^nodes.
  Material wall = material("wall", lambert(0.7));
  wall.temperature_k = 300;
  const auto scene = scene_of({box({-1, -1, -1}, {1, 1, 1}, 0, false)}, {wall});
  const std::vector<Band> bands{Band::rectangular("lwir", 10, 1)};
  std::vector<Ray> rays;
  for (int i = 0; i < 8; ++i) rays.push_back({{0.1, 0.2, -0.3}, dir_from_angles(0.3 + 0.35 * i, 0.9 * i), 0});
  PipelineOptions options;
  options.max_nodes = 24;
  options.roulette_after = 1000;
  const auto run = render(scene, {}, std::make_unique<RaySensor>(rays, bands, 64, 0.1), options);
  const double blackbody = planck_band_radiance(9.5, 10.5, 300), cut = std::pow(0.7, 24);
  for (const double L : run.result.radiance) EXPECT_NEAR(L, blackbody * (1 - cut), 1e-5 * blackbody);
  EXPECT_NEAR(run.report.statistics.truncated / static_cast<double>(run.report.statistics.paths), cut, 1e-4 * cut);
}

TEST(ClosedFurnace, RouletteKeepsTheMean) {
  Material wall = material("wall", lambert(0.7));
  wall.temperature_k = 300;
  const auto scene = scene_of({box({-1, -1, -1}, {1, 1, 1}, 0, false)}, {wall});
  PipelineOptions options;
  options.max_nodes = 64;
  options.roulette_after = 2;
  const auto run =
      render(scene, {},
             std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 0}, {0.6, 0, 0.8}, 0}},
                                         std::vector<Band>{Band::rectangular("lwir", 10, 1)}, 1 << 16, 0.1),
             options);
  const double blackbody = planck_band_radiance(9.5, 10.5, 300);
  EXPECT_NEAR(run.result.radiance[0], blackbody, 4.5 * run.result.standard_error[0]);
  EXPECT_LT(run.result.standard_error[0], 0.01 * blackbody);
}

TEST(LambertPlane, UnderCollimatedSun) {
  // L = rho E cos(z) / pi, to 0.1 %.
  const auto scene = scene_of({quad(5, 0, 0)}, {material("m", lambert(0.37))});
  for (const double zenith : {0.0, 0.5, 1.0, 1.5}) {
    SourceSpecs sources;
    sources.add(SunSpec{dir_from_angles(zenith, 2), 0, Curve::constant(1361)});
    const auto run = render(scene, sources, std::make_unique<RaySensor>(rays_onto_square({0.1, 0.9}), one_band(), 4));
    const double expected = 0.37 * 1361 * std::cos(zenith) / kPi;
    for (const double L : run.result.radiance) EXPECT_NEAR(L, expected, 1e-5 * expected) << zenith;
  }
}

TEST(LambertPlane, UnderSunDisk) {
  // The irradiance of a disk that is wholly above the horizon is that of its centre times cos(z), exactly.
  const auto scene = scene_of({quad(5, 0, 0)}, {material("m", lambert(0.37))});
  for (const double half_angle : {0.0001, 0.00465, 0.1}) {
    SourceSpecs sources;
    sources.add(SunSpec{dir_from_angles(0.8, 2), half_angle, Curve::constant(1361)});
    const auto run =
        render(scene, sources, std::make_unique<RaySensor>(rays_onto_square({0.1, 0.9}), one_band(), 4096));
    const double expected = 0.37 * 1361 * std::cos(0.8) / kPi;
    for (size_t i = 0; i < 2; ++i) EXPECT_NEAR(run.result.radiance[i], expected, 1e-3 * expected) << half_angle;
  }
}

TEST(LambertPlane, ExplicitAndChanceSunsAgree) {
  // A wide sun, met explicitly and by chance (multiple importance sampling) or by chance alone: the same mean.
  const auto scene = scene_of({quad(5, 0, 0)}, {material("m", lambert(0.5))});
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.6, 2), 0.3, Curve::constant(100)});
  PipelineOptions chance;
  chance.explicit_sources = false;
  const auto both = render(scene, sources, std::make_unique<RaySensor>(rays_onto_square({0.3}), one_band(), 1 << 14));
  const auto alone =
      render(scene, sources, std::make_unique<RaySensor>(rays_onto_square({0.3}), one_band(), 1 << 16), chance);
  const double se = std::hypot(both.result.standard_error[0], alone.result.standard_error[0]);
  EXPECT_NEAR(both.result.radiance[0], alone.result.radiance[0], 4.5 * se);
  EXPECT_LT(se, 0.01 * both.result.radiance[0]);
  EXPECT_LT(both.result.standard_error[0] * 2, alone.result.standard_error[0]) << "explicit sampling should pay";
}

TEST(LambertPlane, TabulatedSkyMatchesItsIntegral) {
  // Relative radiance cos^2 of the zenith angle on a fine table: irradiance = L0 2 pi / 4, radiance = rho L0 / 2.
  SkySpec sky{Curve::constant(3), {}, 181, 4, false};
  for (size_t r = 0; r < 181; ++r)
    for (size_t c = 0; c < 4; ++c) sky.table.push_back(std::pow(std::cos(static_cast<double>(r) * kPi / 360), 2));
  SourceSpecs sources;
  sources.add(sky);
  const auto scene = scene_of({quad(5, 0, 0)}, {material("m", lambert(0.5))});
  const auto run = render(scene, sources, std::make_unique<RaySensor>(rays_onto_square({0.3}), one_band(), 1 << 14));
  EXPECT_NEAR(run.result.radiance[0], 0.5 * 3 / 2, 1e-3 * 0.75);  // the table's chords are within 1e-4 of the function
}

TEST(TwoBounces, FloorAndWallExchange) {
  // Two infinite-looking parallel plates would need no closed form here; instead: a floor point under a large parallel
  // ceiling that emits uniformly. Ceiling at 400 K black, floor rho = 0.5 cold: L = rho F B, F = view factor of a
  // square ceiling of half size a at height h from the middle of the floor (Howell C-12, four corner rectangles).
  Material ceiling = material("ceiling", lambert(0));
  ceiling.temperature_k = 400;
  Mesh top = quad(3, 2, 1);
  const auto scene = scene_of({quad(5, 0, 0), top}, {material("floor", lambert(0.5)), ceiling});
  const double a = 3.0 / 2.0;
  const double corner = (1 / (2 * kPi)) * 2 * (a / std::sqrt(1 + a * a)) * std::atan(a / std::sqrt(1 + a * a));
  const double F = 4 * corner, B = planck_band_radiance(9.5, 10.5, 400);
  const auto run =
      render(scene, {},
             std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 1}, {0, 0, -1}, 0}},
                                         std::vector<Band>{Band::rectangular("lwir", 10, 1)}, 1 << 16, 0.1));
  EXPECT_NEAR(run.result.radiance[0], 0.5 * F * B, 1e-3 * 0.5 * F * B + 4 * run.result.standard_error[0]);
}

TEST(Determinism, SameBytesForAnyNumberOfThreads) {
  Material leaf = material("leaf", lambert(0.4, 0.4));
  const auto scene =
      scene_of({quad(5, 0, 0), box({-1, -1, 0.5}, {1, 1, 1.5}, 1, true)}, {material("floor", lambert(0.5)), leaf});
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.6, 2), 0.00465, Curve::constant(1000)});
  sources.add(uniform_sky(20, false));
  std::vector<Ray> rays;
  for (int i = 0; i < 300; ++i) rays.push_back({{-2 + i * 0.013, 0.1, 5}, normalized(Vec3{0.05, 0.02, -1}), 0});
  std::vector<double> first;
  for (const int threads : {1, 2, 5}) {
    set_threads(threads);
    const auto run = render(scene, sources, std::make_unique<RaySensor>(rays, one_band(), 64));
    if (first.empty()) first = run.result.radiance;
    EXPECT_TRUE(std::equal(first.begin(), first.end(), run.result.radiance.begin(), run.result.radiance.end()))
        << threads << " threads";
  }
  set_threads(0);
}

TEST(Nothing, EmptySceneAndNoSourcesAreBlack) {
  const auto empty = scene_of({}, {});
  const auto run =
      render(empty, {}, std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 0}, {0, 0, 1}, 0}}, one_band(), 16));
  EXPECT_EQ(run.result.radiance[0], 0);
  EXPECT_EQ(run.result.standard_error[0], 0);
  const auto dark = render(scene_of({quad(1, 0, 0)}, {material("m", lambert(1))}), {},
                           std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 1}, {0, 0, -1}, 0}}, one_band(), 16));
  EXPECT_EQ(dark.result.radiance[0], 0);
}

}  // namespace
}  // namespace suite::test::furnace_test
