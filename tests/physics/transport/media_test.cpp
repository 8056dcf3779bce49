// Closed forms of paths through media: transmittance, emission, conservation, refraction, and the statistical agreement
// of estimators that share nothing but the physics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "spectral/planck.h"
#include "tests/support/media_kit.h"

namespace suite::test::media_test {
namespace {

// Two-sided at 4.5 standard errors of 64 independent means: less than 1e-4 a comparison by chance.
constexpr double kSigmas = 4.5;

std::vector<Band> bands_at(std::initializer_list<double> centers, double width = 0.01) {
  std::vector<Band> bands;
  for (const double c : centers) bands.push_back(Band::rectangular("b" + std::to_string(c), c, width));
  return bands;
}

// The way of a ray through each cell, found by sorting all planes it crosses and looking at the middles between them.
template <class Visit>
void by_sorting(const VoxelGrid& g, const Affine3& to_world, const Ray& ray, const Visit& visit) {
  const Affine3 to_index = (to_world * g.to_local).inverse();
  const Vec3 o = to_index.point(ray.origin), d = to_index.vector(ray.direction);
  std::vector<double> t{0};
  for (int a = 0; a < 3; ++a)
    for (uint32_t i = 0; i <= g.cells[static_cast<size_t>(a)]; ++i)
      if (d[a] != 0 && (i - o[a]) / d[a] > 0) t.push_back((i - o[a]) / d[a]);
  std::sort(t.begin(), t.end());
  for (size_t k = 1; k < t.size(); ++k) {
    const Vec3 p = o + d * (0.5 * (t[k] + t[k - 1]));
    int cell[3];
    bool inside = true;
    for (int a = 0; a < 3; ++a) {
      cell[a] = static_cast<int>(std::floor(p[a]));
      inside = inside && cell[a] >= 0 && cell[a] < static_cast<int>(g.cells[static_cast<size_t>(a)]);
    }
    if (inside)
      visit((static_cast<size_t>(cell[2]) * g.cells[1] + static_cast<size_t>(cell[1])) * g.cells[0] +
                static_cast<size_t>(cell[0]),
            t[k] - t[k - 1]);
  }
}

std::vector<Ray> rays_through(Vec3 middle, double size, int count) {
  Pcg32 random(5);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Dir d = uniform_sphere({random.uniform(), random.uniform()});
    const Vec3 aim = middle + Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5} * size;
    rays.push_back({aim - d * (3 * size), d, 0});
  }
  for (const Dir d : {Dir{1, 0, 0}, Dir{0, -1, 0}, Dir{0, 0, 1}}) rays.push_back({middle - d * (3 * size), d, 0});
  return rays;
}

TEST(BeerLambert, GridsTurnedScaledAndThin) {
  // 17 x 9 x 30 cells with holes and empty blocks, cells of 1 m, 0.02 m and 1e-4 m, turned and mirrored, and far away.
  const Medium gas = medium(Curve({0.4, 0.9}, {0.5, 2}, Outside::hold), Curve::constant(0));
  const auto density = [](uint32_t i, uint32_t j, uint32_t k) {
    const double u = unit_double(hash_of(i, j, k));
    return k >= 8 && k < 24 ? 0.0 : u < 0.3 ? 0.0 : 3 * u;
  };
  const Affine3 turn = rotation(normalized(Vec3{1, 2, -0.5}), 0.7);
  size_t checked = 0;
  for (const Vec3 cell : {Vec3{1, 1, 1}, Vec3{0.02, 1, 0.3}, Vec3{1, 1e-4, 1}, Vec3{-0.5, 0.5, 0.5}})
    for (const Vec3 away : {Vec3{0, 0, 0}, Vec3{-3e5, 2e5, 1000}}) {
      const VoxelGrid g = grid_of({17, 9, 30}, scaling(cell), density);
      const Affine3 to_world = translation(away) * turn;
      const double size = length((to_world * g.to_local).vector(Vec3{17, 9, 30}));
      const std::vector<Ray> rays = rays_through((to_world * g.to_local).point(Vec3{8.5, 4.5, 15}), size / 3, 40);
      SourceSpecs sources;
      sources.add(uniform_sky(2, true));
      const auto bands = bands_at({0.45, 0.65, 0.85}, 1e-5);
      const auto run = render(scene_with(gas, g, to_world), sources, std::make_unique<RaySensor>(rays, bands, 2));
      for (size_t r = 0; r < rays.size(); ++r) {
        double mass = 0;
        by_sorting(g, to_world, rays[r], [&](size_t c, double way) { mass += way * g.density[c]; });
        for (size_t b = 0; b < 3; ++b) {
          const double expected = 2 * std::exp(-mass * gas.absorption.at(bands[b].center_um));
          EXPECT_NEAR(run.result.radiance[3 * r + b], expected, 1e-4 * expected + 1e-30) << "ray " << r;
          checked += expected < 1.9;
        }
      }
    }
  EXPECT_GT(checked, 200u) << "rays that pass the grid by prove nothing";
}

TEST(BeerLambert, OpticalDepthsFromTinyToHuge) {
  for (const double tau : {1e-6, 1e-3, 1.0, 20.0, 80.0, 1e3, 1e6}) {
    const auto scene =
        scene_with(medium(Curve::constant(tau), Curve::constant(0)),
                   grid_of({1, 1, 4}, translation({-5, -5, 0}) * scaling({10, 10, 0.25}), [](auto...) { return 1; }));
    SourceSpecs sources;
    sources.add(uniform_sky(1, true));
    const auto run = render(scene, sources,
                            std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 3}, {0, 0, -1}, 0}}, one_band(), 2));
    EXPECT_NEAR(run.result.radiance[0], std::exp(-tau), 1e-4 * std::exp(-tau) + 1e-37) << tau;
    // What a cold sky sees of a warm thin gas has all its digits.
    Medium warm = scene->media[0];
    warm.temperature_k = 300;
    auto hot = std::make_shared<Scene>(*scene);
    hot->media[0] = warm;
    const auto glow = render(
        hot, {}, std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 3}, {0, 0, -1}, 0}}, bands_at({10}, 1), 2, 0.1));
    const double expected = -std::expm1(-tau) * planck_band_radiance(9.5, 10.5, 300);
    EXPECT_NEAR(glow.result.radiance[0], expected, 1e-4 * expected) << tau;
  }
}

TEST(Emission, GasOfOneTemperatureIsBlack) {
  // Before a black wall of its own temperature, whatever its density does, with voxel temperatures or the medium's own.
  for (const bool voxels : {false, true}) {
    Medium gas = medium(Curve({8, 12}, {0.01, 3}, Outside::hold), Curve::constant(0));
    gas.temperature_k = voxels ? 0 : 320;
    VoxelGrid g = grid_of({8, 8, 20}, translation({-4, -4, 0}) * scaling({1, 1, 0.1}),
                          [](uint32_t i, uint32_t j, uint32_t k) { return unit_double(hash_of(i, j, k)); });
    if (voxels) g.temperature.assign(g.size(), 320);
    auto scene = scene_with(gas, g, rotation({0, 1, 0}, 0.2));
    Material wall = material("wall", lambert(0));
    wall.temperature_k = 320;
    scene->materials.push_back(wall);
    place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -20}));
    const auto bands = bands_at({8.5, 10, 11.5}, 0.2);
    const auto run =
        render(scene, {},
               std::make_unique<RaySensor>(std::vector<Ray>{{{0.3, 0.1, 30}, normalized(Vec3{0.01, 0.02, -1}), 0}},
                                           bands, 4, 0.05));
    for (size_t b = 0; b < 3; ++b) {
      const double expected = planck_band_radiance(bands[b].low_um(), bands[b].high_um(), 320) / 0.2;
      EXPECT_NEAR(run.result.radiance[b], expected, 2e-4 * expected);
    }
  }
}

TEST(Emission, LayersOfTwoTemperatures) {
  // Closed form: B1 (1 - T1) + T1 B2 (1 - T2).
  Medium gas = medium(Curve::constant(0.7), Curve::constant(0));
  VoxelGrid g = grid_of({1, 1, 2}, translation({-4, -4, 0}) * scaling({8, 8, 1}),
                        [](uint32_t, uint32_t, uint32_t k) { return k ? 1.0 : 2.0; });
  g.temperature = {400, 250};
  const auto run =
      render(scene_with(gas, g), {},
             std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 5}, {0, 0, -1}, 0}}, bands_at({10}, 1), 2, 0.1));
  const double T1 = std::exp(-0.7), T2 = std::exp(-1.4), B1 = planck_band_radiance(9.5, 10.5, 250),
               B2 = planck_band_radiance(9.5, 10.5, 400);
  EXPECT_NEAR(run.result.radiance[0], B1 * (1 - T1) + T1 * B2 * (1 - T2), 1e-4 * B1);
}

TEST(Emission, ScatteringGasInAnIsothermalBoxIsBlack) {
  // Scattering that changes with wavelength by a factor of 30 included: the balance heuristic over flights.
  for (const bool spectral : {false, true}) {
    Medium gas = medium(Curve({8, 12}, {0.2, 0.5}, Outside::hold),
                        spectral ? Curve({8, 12}, {3, 0.1}, Outside::hold) : Curve::constant(1), hg(0.6));
    gas.temperature_k = 300;
    auto scene = scene_of({box({-2, -2, -2}, {2, 2, 2}, 0, false)}, {material("wall", lambert(0.5))});
    scene->materials[0].temperature_k = 300;
    scene->media = {gas};
    scene->ambient = 0;
    PipelineOptions options;
    options.max_nodes = 40;
    const auto bands = bands_at({8.5, 10, 11.5}, 0.2);
    const auto run = render(
        scene, {}, std::make_unique<RaySensor>(repeated({{0.1, 0.2, 0.3}, {0.6, 0, 0.8}, 0}), bands, 1 << 8, 0.05),
        options);
    for (size_t b = 0; b < 3; ++b) {
      const double expected = planck_band_radiance(bands[b].low_um(), bands[b].high_um(), 300) / 0.2;
      const Repeated got = over_problems(run.result, b);
      EXPECT_NEAR(got.mean, expected, kSigmas * got.error + 1e-4 * expected) << b << (spectral ? " spectral" : "");
      EXPECT_LT(got.error, 0.01 * expected);
    }
  }
}

TEST(Furnace, ConservativeBodiesVanish) {
  // Albedo 1 in a uniform field: every path brings the field's radiance, whatever the shape, the phase function and the
  // nesting; forward and backward peaks included.
  for (const ModelSpec& phase :
       {hg(0), hg(0.9999), hg(-0.9999), hg(0.85), ModelSpec{"rayleigh", {{"depolarisation", 0.03}}, {}, {}, nullptr}}) {
    auto scene = std::make_shared<Scene>();
    Medium dense = medium(Curve::constant(0), Curve::constant(20), hg(0.3));
    dense.priority = 1;
    scene->media = {medium(Curve::constant(0), Curve::constant(3), phase), dense};
    scene->materials = {boundary(0), boundary(1)};
    place(*scene, PrimitiveKind::sphere, {1}, 0);
    place(*scene, PrimitiveKind::sphere, {0.5}, 1, translation({0.7, 0, 0}));  // half in, half out
    scene->grids.push_back(grid_of({4, 4, 4}, translation({-1, -1, -0.2}) * scaling({0.5, 0.5, 0.5}),
                                   [](uint32_t i, uint32_t j, uint32_t k) { return (i + j + k) % 3; }));
    scene->volumes.push_back({0, rotation({0, 0, 1}, 0.5)});
    check_scene(*scene, "furnace");
    SourceSpecs sources;
    sources.add(uniform_sky(2, true));
    const std::vector<Ray> rays{{{0, 0, 5}, {0, 0, -1}, 0},
                                {{5, 0.1, 0.1}, {-1, 0, 0}, 0},
                                {{0, 0, 0}, {0.6, 0, 0.8}, 0},
                                {{0.7, 0, 0}, {0, 1, 0}, 0}};
    const auto run = render(scene, sources, std::make_unique<RaySensor>(rays, one_band(), 256));
    for (const double L : run.result.radiance) EXPECT_NEAR(L, 2, 2e-4) << phase.model;
    EXPECT_EQ(run.report.statistics.failures, 0u);
    EXPECT_EQ(run.report.statistics.truncated, 0);
  }
}

TEST(Furnace, OpticalDepthSweep) {
  // A slab with albedo 1 - 1e-7 in a uniform field: what does not come out is in the report of the cut energy.
  for (const double tau : {1e-6, 1e-3, 1.0, 30.0, 1e3, 1e6}) {
    SourceSpecs sources;
    sources.add(uniform_sky(1, true));
    PipelineOptions options;
    options.max_scatterings = 3000;
    const auto scene = slab_scene(medium(Curve::constant(1e-7 * tau), Curve::constant((1 - 1e-7) * tau)), 1);
    const auto run =
        render(scene, sources,
               std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 2}, {0.6, 0, -0.8}, 0}}, one_band(), 256), options);
    const double cut = run.report.statistics.truncated / static_cast<double>(run.report.statistics.paths);
    EXPECT_NEAR(run.result.radiance[0] + cut, 1, 3e-4) << tau;
    EXPECT_LT(cut, 0.1) << tau;
  }
}

TEST(Inside, CamerasInsideNestedBodies) {
  // Two absorbing spheres, the inner one of higher priority; the camera in the inner one's middle, off it, and outside.
  auto scene = std::make_shared<Scene>();
  Medium inner = medium(Curve::constant(2), Curve::constant(0));
  inner.priority = 1;
  scene->media = {medium(Curve::constant(0.5), Curve::constant(0)), inner,
                  medium(Curve::constant(0.01), Curve::constant(0))};
  scene->materials = {boundary(0), boundary(1)};
  place(*scene, PrimitiveKind::sphere, {3}, 0);
  place(*scene, PrimitiveKind::sphere, {1}, 1);
  SourceSpecs sources;
  sources.add(uniform_sky(1, true));
  const std::vector<Ray> rays{
      {{0, 0, 0}, {0, 0, 1}, 0}, {{0, 0, 2}, {0, 0, 1}, 0}, {{0, 0, 2}, {0, 0, -1}, 0}, {{0, 0, 9}, {0, 0, -1}, 0}};
  const std::vector<double> expected{2 + 1, 0.5, 0.5 + 4 + 1, 1 + 4 + 1};
  const auto run = render(scene, sources, std::make_unique<RaySensor>(rays, one_band(), 2));
  for (size_t i = 0; i < rays.size(); ++i)
    EXPECT_NEAR(run.result.radiance[i], std::exp(-expected[i]), 1e-4 * std::exp(-expected[i])) << i;
  // An ambient medium fills what no body does, without end: nothing of the sky is left.
  scene->ambient = 2;
  const auto fog = render(scene, sources, std::make_unique<RaySensor>(rays, one_band(), 2));
  for (const double L : fog.result.radiance) EXPECT_EQ(L, 0);
}

TEST(Shadows, GroundUnderAnAbsorbingGrid) {
  // Sun through a grid onto a Lambert plane, seen from beside: rho E cos / pi exp(-tau / cos), collimated and as a
  // disk; and through a body behind an index-matched boundary.
  const double zenith = 0.5, rho = 0.4, E = 1000;
  for (const bool body : {false, true})
    for (const double half_angle : {0.0, 0.00465}) {
      const Medium gas = medium(Curve({0.4, 0.9}, {0.5, 2}, Outside::hold), Curve::constant(0));
      auto scene = std::make_shared<Scene>();
      scene->groups.push_back({"root", {}});
      scene->media = {gas};
      scene->materials = {material("ground", lambert(rho)), boundary(0)};
      place(*scene, PrimitiveKind::plane, {0, 0}, 0);
      if (body) {
        place(*scene, PrimitiveKind::box, {-20, -20, 10, 20, 20, 11}, 1);
      } else {
        scene->grids.push_back(grid_of({10, 10, 3}, translation({-500, -500, 10}) * scaling({100, 100, 1.0 / 3}),
                                       [](auto...) { return 1; }));
        scene->volumes.push_back({0, {}});
      }
      SourceSpecs sources;
      sources.add(SunSpec{dir_from_angles(zenith, 2), half_angle, Curve::constant(E)});
      const auto bands = bands_at({0.45, 0.65, 0.85}, 1e-5);
      const auto run = render(
          scene, sources,
          std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 5}, normalized(Vec3{0.2, 0, -1}), 0}}, bands, 1024));
      for (size_t b = 0; b < 3; ++b) {
        const double expected =
            rho * E * std::cos(zenith) / kPi * std::exp(-gas.absorption.at(bands[b].center_um) / std::cos(zenith));
        EXPECT_NEAR(run.result.radiance[b], expected, 2e-4 * expected) << body << half_angle;
      }
    }
}

// A cloud of two overlapping media with wavelength-dependent scattering and peaked phase functions over bright ground.
std::shared_ptr<Scene> coloured_cloud() {
  const Medium droplets = medium(Curve::constant(0.05), Curve({0.4, 0.9}, {1, 6}, Outside::hold), hg(0.8));
  const Medium smoke = medium(Curve({0.4, 0.9}, {1, 0.1}, Outside::hold), Curve({0.4, 0.9}, {4, 0.5}, Outside::hold),
                              {"hg", {}, {{"g", Curve({0.4, 0.9}, {0.7, 0.1}, Outside::hold)}}, {}, nullptr});
  auto scene = std::make_shared<Scene>();
  scene->media = {droplets, smoke};
  scene->materials = {material("ground", lambert(0.6)), boundary(1)};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -1.5}));
  place(*scene, PrimitiveKind::sphere, {0.8}, 1, translation({0.3, 0, 0}));
  scene->grids.push_back(grid_of({6, 6, 6}, translation({-1, -1, -1}) * scaling({0.33, 0.33, 0.33}),
                                 [](uint32_t i, uint32_t j, uint32_t k) { return (i * j + k) % 4 * 0.5; }));
  scene->volumes.push_back({0, rotation({0, 1, 0}, 0.3)});
  check_scene(*scene, "cloud");
  return scene;
}
SourceSpecs sun_and_sky(double half_angle) {
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.6, 1), half_angle, Curve::constant(2)});
  SkySpec sky{Curve::constant(1), {}, 10, 4, false};
  for (size_t r = 0; r < 10; ++r)
    for (size_t c = 0; c < 4; ++c) sky.table.push_back(r < 3 ? 2.0 : 0.5 + 0.2 * static_cast<double>(c));
  sources.add(sky);
  return sources;
}
const Ray kOntoCloud{{3, 0.5, 4}, normalized(Vec3{-3, -0.4, -4}), 0};

TEST(Spectral, SharedPathsAgreeWithOneWavelengthAtATime) {
  const auto scene = coloured_cloud();
  const auto bands = bands_at({0.42, 0.55, 0.7, 0.88});
  const auto together =
      render(scene, sun_and_sky(0.2), std::make_unique<RaySensor>(repeated(kOntoCloud), bands, 448, 0.01));
  for (size_t b = 0; b < bands.size(); ++b) {
    PipelineOptions other;
    other.seed = 100 + b;
    const auto alone =
        render(scene, sun_and_sky(0.2),
               std::make_unique<RaySensor>(repeated(kOntoCloud), std::vector<Band>{bands[b]}, 256, 0.01), other);
    const Repeated one = over_problems(alone.result, 0), all = over_problems(together.result, b);
    EXPECT_NEAR(one.mean, all.mean, kSigmas * std::hypot(one.error, all.error)) << bands[b].center_um;
    EXPECT_LT(all.error, 0.02 * all.mean);
    std::printf("%.2f um: together %.5f +- %.2f %%, alone %.5f +- %.2f %%\n", bands[b].center_um, all.mean,
                100 * all.error / all.mean, one.mean, 100 * one.error / one.mean);
    // Control: 6 % would be seen.
    EXPECT_GT(0.06 * one.mean, kSigmas * std::hypot(one.error, all.error)) << bands[b].center_um;
  }
  EXPECT_EQ(together.report.statistics.failures, 0u);
}

TEST(Spectral, ExplicitAndChanceLightAgree) {
  PipelineOptions chance;
  chance.explicit_sources = false;
  chance.seed = 3;
  const auto scene = coloured_cloud();
  const auto bands = bands_at({0.42, 0.88});
  const auto both = render(scene, sun_and_sky(0.3), std::make_unique<RaySensor>(repeated(kOntoCloud), bands, 192));
  const auto alone =
      render(scene, sun_and_sky(0.3), std::make_unique<RaySensor>(repeated(kOntoCloud), bands, 768), chance);
  for (size_t b = 0; b < 2; ++b) {
    const Repeated x = over_problems(both.result, b), y = over_problems(alone.result, b);
    EXPECT_NEAR(x.mean, y.mean, kSigmas * std::hypot(x.error, y.error));
    std::printf("both %.5f +- %.2f %%, by chance %.5f +- %.2f %%\n", x.mean, 100 * x.error / x.mean, y.mean,
                100 * y.error / y.mean);
    EXPECT_GT(0.08 * x.mean, kSigmas * std::hypot(x.error, y.error)) << "a difference would not be seen";
  }
}

// Flat water with its front side up; `index` constant.
std::shared_ptr<Scene> water(double index, const Medium& body) {
  auto scene = std::make_shared<Scene>();
  ModelSpec skin{"dielectric", {}, {{"index", Curve::constant(index)}}, {}, nullptr};
  scene->materials = {material("water", skin)};
  scene->media = {body};
  scene->media[0].index = Curve::constant(index);
  scene->materials[0].inside = 0;
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  check_scene(*scene, "water");
  return scene;
}
double fresnel_unpolarised(double cos_i, double n) {
  const double cos_t = std::sqrt(1 - (1 - cos_i * cos_i) / (n * n));
  const double s = (cos_i - n * cos_t) / (cos_i + n * cos_t), p = (cos_t - n * cos_i) / (cos_t + n * cos_i);
  return 0.5 * (s * s + p * p);
}

TEST(Water, RadianceOverIndexSquaredIsKept) {
  // From below a uniform sky of radiance L stands in Snell's window as n^2 (1 - R) L exp(-tau); beyond the critical
  // angle nothing comes but what the water sends, none here.
  const double n = 1.34, depth = 3;
  const auto scene = water(n, medium(Curve::constant(0.1), Curve::constant(0)));
  SourceSpecs sources;
  sources.add(uniform_sky(5, false));
  const std::vector<double> zeniths{0, 0.3, 0.6, 0.9, 1.2};
  std::vector<Ray> rays;
  for (const double z : zeniths) rays.push_back({{0, 0, -depth}, dir_from_angles(z, 0.3), 0});
  const auto run = render(scene, sources, std::make_unique<RaySensor>(rays, one_band(), 1 << 14));
  for (size_t i = 0; i < zeniths.size(); ++i) {
    const double sin_air = n * std::sin(zeniths[i]);
    const double expected = sin_air >= 1 ? 0
                                         : n * n * (1 - fresnel_unpolarised(std::sqrt(1 - sin_air * sin_air), n)) * 5 *
                                               std::exp(-0.1 * depth / std::cos(zeniths[i]));
    EXPECT_NEAR(run.result.radiance[i], expected, 1e-3 * expected + 4.5 * run.result.standard_error[i]) << zeniths[i];
    EXPECT_LE(run.result.standard_error[i], 5e-3 * expected);
  }
}

TEST(Water, WarmWaterShinesThroughItsSurface) {
  // Seen from above: (1 - R) B(T): the n^2 of emission inside goes at the surface.
  Medium body = medium(Curve::constant(100), Curve::constant(0));
  body.temperature_k = 290;
  const auto scene = water(1.34, body);
  for (const double zenith : {0.0, 0.8, 1.3}) {
    const Dir d = -dir_from_angles(zenith, 1);
    const auto run = render(
        scene, {}, std::make_unique<RaySensor>(std::vector<Ray>{{d * -10.0, d, 0}}, bands_at({10}, 1), 1 << 14, 0.1));
    const double expected = (1 - fresnel_unpolarised(std::cos(zenith), 1.34)) * planck_band_radiance(9.5, 10.5, 290);
    EXPECT_NEAR(run.result.radiance[0], expected, 2e-3 * expected) << zenith;
  }
}

TEST(Water, SmallestDeviationOfADispersivePrism) {
  // delta = i + asin(n sin(A - asin(sin i / n))) - A for each colour: a sun of 2 mrad at the angle of one colour is
  // seen by that colour alone, with radiance (1 - R)^2 L_sun.
  const Curve glass({0.4, 0.9}, {1.56, 1.50}, Outside::hold);
  const double A = 60 * kDegree, incidence = 0.85;
  ModelSpec skin{"dielectric", {}, {{"index", glass}}, {}, nullptr};
  // Apex up, base on z = 0; the cross-section lies in the xz plane.
  const double h = std::sqrt(3.0), y = 5;
  const auto scene = scene_of({mesh_of({{-1, -y, 0}, {1, -y, 0}, {0, -y, h}, {-1, y, 0}, {1, y, 0}, {0, y, h}},
                                       {0, 1, 2, 3, 5, 4, 0, 3, 4, 0, 4, 1, 1, 4, 5, 1, 5, 2, 2, 5, 3, 2, 3, 0}, 0)},
                              {material("glass", skin)});
  // Onto the left face, whose normal is at 150 degrees from +x in the xz plane.
  const double normal = kPi - 30 * kDegree;
  const double from = normal + incidence;  // the side towards the base
  const Vec3 aim{-0.5, 0, h / 2};
  const Dir back{std::cos(from), 0, std::sin(from)};
  const Ray ray{aim + back * 5.0, -back, 0};
  const std::vector<double> colours{0.45, 0.6, 0.8};
  for (size_t c = 0; c < colours.size(); ++c) {
    const double n = glass.at(colours[c]), inside = A - std::asin(std::sin(incidence) / n);
    const double delta = incidence + std::asin(n * std::sin(inside)) - A;
    const double travel = from + kPi - delta;  // turned towards the base, clockwise
    SourceSpecs sources;
    sources.add(SunSpec{{{std::cos(travel), 0, std::sin(travel)}, 1e-3, Curve::constant(1)}});
    std::vector<Band> bands = bands_at({colours[0], colours[1], colours[2]}, 1e-4);
    const auto run = render(scene, sources, std::make_unique<RaySensor>(repeated(ray), bands, 1 << 9));
    const double R1 = fresnel_unpolarised(std::cos(incidence), n), R2 = fresnel_unpolarised(std::cos(inside), 1 / n);
    const double expected = (1 - R1) * (1 - R2) / (kPi * std::pow(std::sin(1e-3), 2));
    for (size_t b = 0; b < colours.size(); ++b) {
      const Repeated got = over_problems(run.result, b);
      if (b == c)
        EXPECT_NEAR(got.mean, expected, kSigmas * got.error + 1e-3 * expected);
      else
        EXPECT_EQ(got.mean, 0) << colours[b] << " in the sun of " << colours[c];
    }
  }
}

}  // namespace
}  // namespace suite::test::media_test
