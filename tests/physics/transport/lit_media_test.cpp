// Media in air that knows the scene: bodies and voxels in the field over an even ground, with what paths find of the
// scene in the air between and within them, against paths that are scattered in the same layers every time, and against
// the same air without media.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "light/kinds/night_sky.h"
#include "spectral/planck.h"
#include "tests/support/lit_air_kit.h"
#include "tests/support/media_kit.h"

namespace suite::test::lit_media_test {
namespace {

void tell(const char* what, const CaptureResult& a, const CaptureResult& b) {
  for (size_t i = 0; i < a.radiance.size(); ++i)
    std::printf("%s %zu: %.6g +- %.2g, beside %.6g +- %.2g, off %.2f %%\n", what, i, a.radiance[i], a.standard_error[i],
                b.radiance[i], b.standard_error[i], 100 * (a.radiance[i] / b.radiance[i] - 1));
}
// SUITE_LONG: so many times the paths.
uint32_t many(uint32_t paths, uint32_t in_default) {
  const char* factor = std::getenv("SUITE_LONG");
  return factor ? static_cast<uint32_t>(std::max(1, std::atoi(factor))) * paths : in_default;
}
uint32_t many(uint32_t paths) { return many(paths, paths); }

SourceSpecs sun_in(AirSpec air, AirScattering scattering, bool adjacency = true) {
  air.scattering = scattering, air.adjacency = adjacency;
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  sources.add(SunSpec{{dir_from_angles(50 * kDegree, 0.3), 0, Curve::constant(1)}});
  return sources;
}
CaptureResult see(const std::shared_ptr<Scene>& scene, const SourceSpecs& sources, const std::vector<Ray>& rays,
                  uint32_t paths) {
  const std::vector<Band> bands{Band::rectangular("blue", 0.45, 0.01), Band::rectangular("red", 0.67, 0.01)};
  return render(scene, sources, std::make_unique<RaySensor>(rays, bands, paths, 0.02)).result;
}

// A dark sea and a bright land that meet at x = 0.
std::shared_ptr<Scene> coast() {
  constexpr double far = 1e5;
  const auto half = [](double low, double high, uint32_t material) {
    return mesh_of({{low, -far, 0}, {high, -far, 0}, {high, far, 0}, {low, far, 0}}, {0, 1, 2, 0, 2, 3}, material);
  };
  return scene_of({half(-far, 0, 0), half(0, far, 1)},
                  {material("sea", lambert(0.02)), material("land", lambert(0.6))});
}
void put_body(Scene& scene, const Medium& m, Vec3 low, Vec3 high) {
  scene.media.push_back(m);
  scene.materials.push_back(boundary(static_cast<uint32_t>(scene.media.size() - 1)));
  scene.meshes.push_back(box(low, high, static_cast<uint32_t>(scene.materials.size() - 1), true));
  Placement p;
  p.target = static_cast<uint32_t>(scene.meshes.size() - 1);
  scene.groups[0].placements.push_back(p);
  check_scene(scene, "body");
}
void put_grid(Scene& scene, const Medium& m, VoxelGrid grid) {
  scene.media.push_back(m);
  grid.media = {static_cast<uint32_t>(scene.media.size() - 1)};
  scene.grids.push_back(std::move(grid));
  scene.volumes.push_back({static_cast<uint32_t>(scene.grids.size() - 1), {}});
  check_scene(scene, "grid");
}
Medium almost_nothing() { return medium(Curve::constant(5e-10), Curve::constant(5e-10), hg(0.8)); }
const std::vector<Ray> kOverTheCoast{from_space({-500, 0, 0}, 0, 0), from_space({800, 0, 0}, 30, 1)};

// A body and a cloud of next to nothing, wide of the line of sight and around it, change nothing.
TEST(LitMedia, NextToNothingChangesNothing) {
  const SourceSpecs air = sun_in(haze(0.4), AirScattering::diffuse);
  const CaptureResult empty = see(coast(), air, kOverTheCoast, many(4000, 2400));
  auto body = coast();
  put_body(*body, almost_nothing(), {-6000, -6000, 200}, {5000, 5000, 3000});
  auto cloud = coast();
  put_grid(*cloud, almost_nothing(),
           grid_of({2, 2, 2}, translation({-4000, -4000, 100}) * scaling({4000, 4000, 1500}),
                   [](uint32_t, uint32_t, uint32_t) { return 1.0; }));
  for (const auto& scene : {body, cloud}) {
    const CaptureResult filled = see(scene, air, kOverTheCoast, many(4000, 2400));
    tell(scene == body ? "thin body" : "thin cloud", filled, empty);
    EXPECT_LT(largest_z(filled, empty, 0.001), kSigmas);
    for (size_t i = 0; i < filled.radiance.size(); ++i)
      EXPECT_LT(filled.standard_error[i], 0.02 * filled.radiance[i]) << i;
  }
  // Control: without what paths find, the air over the sea lacks the land's light.
  const CaptureResult even = see(body, sun_in(haze(0.4), AirScattering::diffuse, false), kOverTheCoast, 2000);
  EXPECT_GT(largest_z(even, empty, 0.001), 3 * kSigmas);
}

// A cloud of voxels and a bank of haze over the coast, views past them, through them and in their shadows.
TEST(LitMedia, ACloudOverACoastIsThatOfTracedAir) {
  auto scene = coast();
  put_grid(*scene, medium(Curve::constant(0), Curve::constant(0.01), hg(0.85)),
           grid_of({4, 4, 2}, translation({-2000, -2000, 1000}) * scaling({500, 500, 300}),
                   [](uint32_t i, uint32_t j, uint32_t k) { return 0.5 + 0.25 * ((i + j + k) % 3); }));
  put_body(
      *scene,
      medium(Curve({0.4, 0.7}, {4e-5, 2e-5}, Outside::hold), Curve({0.4, 0.7}, {4e-4, 2e-4}, Outside::hold), hg(0.7)),
      {500, -3000, 50}, {3000, 3000, 800});
  const Dir sun = dir_from_angles(50 * kDegree, 0.3);
  const Vec3 shadow = Vec3{-1000, -1000, 1300} - sun * (1300 / sun.z);
  const std::vector<Ray> rays{from_space({-1000, -1000, 0}, 0, 0),                 // onto the cloud
                              from_space({1500, 300, 0}, 20, 2),                   // through the bank
                              from_space(shadow, 0, 0),                            // beside the cloud, into its shadow
                              {{-3500, 0, 300}, normalized(Vec3{1, 0, 0.1}), 0}};  // from under it
  const AirSpec air = haze(0.4);
  const CaptureResult traced = see(scene, sun_in(air, AirScattering::traced), rays, many(6000)),
                      lit = see(scene, sun_in(air, AirScattering::diffuse), rays, many(3000));
  tell("cloud", lit, traced);
  EXPECT_LT(largest_z(lit, traced), kSigmas);
  for (size_t i = 0; i < lit.radiance.size(); ++i) EXPECT_LT(lit.standard_error[i], 0.05 * lit.radiance[i]) << i;
  EXPECT_GT(largest_z(see(scene, sun_in(air, AirScattering::diffuse, false), rays, 2000), traced), kSigmas);  // control
}

// A plume of dark smoke along the coast.
TEST(LitMedia, APlumeOverACoastIsThatOfTracedAir) {
  auto scene = coast();
  put_grid(*scene, medium(Curve::constant(0.002), Curve({0.4, 0.7}, {0.004, 0.002}, Outside::hold), hg(0.6)),
           grid_of({1, 8, 1}, translation({-600, -2400, 100}) * scaling({400, 600, 300}),
                   [](uint32_t, uint32_t j, uint32_t) { return 1.0 - 0.1 * j; }));
  const std::vector<Ray> rays{from_space({-400, 0, 0}, 0, 0), from_space({-900, 300, 0}, 25, 3)};
  const AirSpec air = haze(0.4);
  const CaptureResult traced = see(scene, sun_in(air, AirScattering::traced), rays, many(8000, 4000)),
                      lit = see(scene, sun_in(air, AirScattering::diffuse), rays, many(4000, 2000));
  tell("plume", lit, traced);
  EXPECT_LT(largest_z(lit, traced), kSigmas);
  EXPECT_GT(largest_z(see(scene, sun_in(air, AirScattering::diffuse, false), rays, 2000), traced), kSigmas);  // control
}

// Water that scatters, beside bright land: paths that are split in it, guided and connected through its surface go back
// to the air as well.
TEST(LitMedia, WaterBesideLandIsThatOfTracedAir) {
  if (!std::getenv("SUITE_LONG")) GTEST_SKIP() << "paths through water in traced air take minutes: set SUITE_LONG";
  constexpr double kFar = 3e4;
  Medium water = medium(Curve::constant(0.05), Curve::constant(0.2), hg(0.9));
  water.index = Curve::constant(1.34);
  Material surface = material("surface", {"dielectric", {}, {{"index", Curve::constant(1.34)}}, {}, nullptr});
  surface.inside = 0;
  auto scene =
      scene_of({box({-kFar, -kFar, -20}, {0, kFar, 0}, 0, true),
                mesh_of({{0, -kFar, 0}, {kFar, -kFar, 0}, {kFar, kFar, 0}, {0, kFar, 0}}, {0, 1, 2, 0, 2, 3}, 1),
                quad(kFar, -40, 2)},
               {material("void", lambert(0)), material("land", lambert(0.6)), material("bed", lambert(0.1))});
  scene->media = {water};
  scene->materials[0] = surface;
  check_scene(*scene, "water");
  const std::vector<Ray> rays{from_space({-300, 0, 0}, 0, 0), from_space({-800, 500, 0}, 25, 3)};
  const AirSpec air = haze(0.4);
  const CaptureResult traced = see(scene, sun_in(air, AirScattering::traced), rays, many(16000)),
                      lit = see(scene, sun_in(air, AirScattering::diffuse), rays, many(4000));
  tell("water", lit, traced);
  EXPECT_LT(largest_z(lit, traced), kSigmas);
  EXPECT_GT(largest_z(see(scene, sun_in(air, AirScattering::diffuse, false), rays, 4000), traced), kSigmas);  // control
}

// A night sky, of which the field knows nothing: what the air scatters of it beside media is what it scatters without.
TEST(LitMedia, ANightSkyIsScatteredBesideMedia) {
  NightSkyLightSpec night;
  night.scale = {0, 0, 0, 1, 0};
  night.time.utc = "2026-03-20T22:00:00Z";
  night.place = Geodetic{49.4, 8.7, 0};
  SourceSpecs sources;
  sources.add(night);
  auto air = std::make_shared<AirSpec>();
  air->profile = standard_profile("us_standard");
  air->round = false;
  sources.air = air;
  auto even = std::make_shared<AirSpec>(*air);
  even->adjacency = false;
  SourceSpecs dimmed = sources;
  dimmed.air = even;
  const auto ground = [] { return scene_of({quad(2e5, 0, 0)}, {material("ground", lambert(0.2))}); };
  auto filled = ground();
  put_body(*filled, almost_nothing(), {-500, -500, 10}, {500, 500, 800});
  const std::vector<Ray> rays{{{0, 0, 2}, {0, 0, 1}, 0}, {{0, 0, 2}, normalized(Vec3{0, 0.98, 0.2}), 0}};
  const CaptureResult empty = see(ground(), sources, rays, many(2048)), here = see(filled, sources, rays, many(2048));
  tell("night", here, empty);
  EXPECT_LT(largest_z(here, empty, 0.002), kSigmas);
  EXPECT_GT(largest_z(see(filled, dimmed, rays, 512), empty, 0.002), kSigmas);  // control
}

// A closed room of one temperature, with haze of air and a cloud of that temperature in it, is filled with its
// blackbody's radiance, whatever the field over an even ground under cold space is.
TEST(LitMedia, ARoomOfOneTemperatureIsAFurnace) {
  constexpr double kKelvin = 290;
  AirSpec air = haze(2);
  air.round = false;
  for (AirLevel& level : air.profile.levels) level.temperature = kKelvin;
  Material wall = material("wall", lambert(0.6));
  wall.temperature_k = kKelvin;
  auto room = scene_of({box({-4e3, -4e3, 0}, {4e3, 4e3, 3e3}, 0, false)}, {wall});
  Medium fog = medium(Curve::constant(1e-4), Curve({3, 4}, {2e-3, 1e-3}, Outside::hold), hg(0.6));
  fog.temperature_k = kKelvin;
  put_body(*room, fog, {-1e3, -1e3, 500}, {1e3, 1e3, 1500});
  put_grid(*room, fog,
           grid_of({2, 1, 1}, translation({1500, -500, 300}) * scaling({500, 1000, 500}),
                   [](uint32_t i, uint32_t, uint32_t) { return i ? 0.3 : 1.0; }));
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  const std::vector<Band> bands{Band::rectangular("a", 3.1, 0.01), Band::rectangular("b", 3.9, 0.01)};
  const auto seen = [&](bool adjacency) {
    AirSpec here = air;
    here.adjacency = adjacency;
    sources.air = std::make_shared<const AirSpec>(here);
    return render(room, sources,
                  std::make_unique<RaySensor>(std::vector<Ray>{{{-3e3, 0, 1e3}, normalized(Vec3{1, 0.1, 0}), 0},
                                                               {{3e3, 100, 2e3}, normalized(Vec3{-1, -0.3, -0.5}), 0}},
                                              bands, many(4000), 0.02))
        .result;
  };
  const CaptureResult lit = seen(true), even = seen(false);
  double largest = 0;
  for (size_t i = 0; i < lit.radiance.size(); ++i) {
    const Band& band = bands[i % 2];
    const double B = planck_band_radiance(band.low_um(), band.high_um(), kKelvin) / (band.high_um() - band.low_um());
    std::printf("furnace %zu: %.5f +- %.5f of B, even %.5f\n", i, lit.radiance[i] / B, lit.standard_error[i] / B,
                even.radiance[i] / B);
    EXPECT_NEAR(lit.radiance[i], B, kSigmas * lit.standard_error[i] + 1e-3 * B) << i;
    EXPECT_LT(lit.standard_error[i], 0.02 * B) << i;
    largest = std::max(largest, std::fabs(even.radiance[i] - B) / (kSigmas * even.standard_error[i] + 1e-3 * B));
  }
  EXPECT_GT(largest, 1);  // control
}

}  // namespace
}  // namespace suite::test::lit_media_test
