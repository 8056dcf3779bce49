// Water over a bed under the sun and real air, whose light is asked for through the calm surface along chains
// (transport/techniques/volume_chains.h), against paths that meet the sky by chance: a glass ball far away, which no
// path sees, is enough for nobody to know how many ways lead through the surface (transport/refracting_sheet.h).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <span>

#include "air/air_spec.h"
#include "scheduler/shortfall.h"
#include "tests/support/media_kit.h"
#include "tests/support/radiometry_kit.h"
#include "transport/refracting_sheet.h"

namespace suite::test::water_chain_test {
namespace {

constexpr double kIndex = 1.34;
const Affine3 kUpright = rotation({0, 1, 0}, kPi / 2);  // what looked up looks along x

// Waves along x with vertex normals: n x n vertices, 0.5 m apart, from a corner.
Mesh waves(uint32_t n, double from, double height, double length, uint32_t material) {
  Mesh mesh;
  std::vector<float> positions;
  std::vector<uint32_t> indices, normals;
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const double k = 2 * kPi / length, x = from + 0.5 * i, y = from + 0.5 * j;
      for (const double v : {x, y, height * std::sin(k * x)}) positions.push_back(static_cast<float>(v));
      normals.push_back(oct_encode(normalized(Vec3{-height * k * std::cos(k * x), 0, 1})));
      if (i + 1 == n || j + 1 == n) continue;
      const uint32_t a = j * n + i;
      for (const uint32_t v : {a, a + 1, a + n + 1, a, a + n + 1, a + n}) indices.push_back(v);
    }
  positions.push_back(0);
  mesh.positions = std::move(positions), mesh.indices = std::move(indices), mesh.normals = std::move(normals);
  mesh.parts = {{"all", 0, static_cast<uint32_t>(mesh.indices.size() / 3), material}};
  return mesh;
}

struct Bay {
  double absorption = 0.05, scattering = 0.25;  // 1/m
  double depth = 4;                             // m
  bool bed = true;
  double high = 0;  // of waves 4 m long, m; 0 = flat water, without an end
  double wide = 200;
  bool upright = false;  // the surface faces the horizon
  bool layers = false;   // murkier from 1 to 2.5 m, dark below
  bool haze = false;     // a body of it over the water
  bool mirrors = false;  // half of the bed
};

// Media that nothing parts from what is above but their boundaries.
void add_layers(Scene& scene, const Bay& bay) {
  const double tops[] = {1, 2.5}, scattering[] = {2.4, 0.5}, absorption[] = {1, 2}, g[] = {0.85, 0.9};
  for (uint32_t i = 0; i < 2; ++i) {
    Medium m = medium(Curve::constant(absorption[i] * bay.absorption), Curve::constant(scattering[i] * bay.scattering),
                      hg(g[i]));
    m.id = strf("layer %u", i), m.index = Curve::constant(kIndex), m.priority = static_cast<int>(i) + 1;
    scene.media.push_back(m);
    scene.materials.push_back(boundary(i + 1));
    scene.materials.back().id = strf("border %u", i);
    place(scene, PrimitiveKind::plane, {0, 0}, static_cast<uint32_t>(scene.materials.size()) - 1,
          translation({0, 0, -tops[i]}));
  }
}

void add_haze(Scene& scene) {
  scene.media.push_back(medium(Curve::constant(0.05), Curve::constant(0.1), hg(0.7)));
  scene.media.back().id = "haze";
  scene.materials.push_back(boundary(static_cast<uint32_t>(scene.media.size()) - 1));
  scene.materials.back().id = "haze";
  place(scene, PrimitiveKind::box, {-20, -20, 5, 20, 20, 8}, static_cast<uint32_t>(scene.materials.size()) - 1);
}

// The bed, material 0, becomes a mixture.
void add_mirrors(Scene& scene) {
  PropertyMap shares;
  shares.name = "shares", shares.width = shares.height = 1, shares.channels = 2;
  shares.values = {0.5f, 0.5f};
  for (const Material& part :
       {material("white", lambert(0.3)),
        material("mirror", {"mirror", {}, {{"reflectance", Curve::constant(0.9)}}, {}, nullptr})}) {
    shares.materials.push_back(static_cast<uint32_t>(scene.materials.size()));
    scene.materials.push_back(part);
  }
  scene.property_maps = {shares};
  scene.property_bindings = {{0, 0}};
}

// ball: nobody knows how many ways there are.
std::shared_ptr<Scene> scene_with(const Bay& bay, bool ball = false) {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(bay.absorption), Curve::constant(bay.scattering), hg(0.9))};
  scene->media[0].index = Curve::constant(kIndex);
  Material surface = material("surface", {"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr});
  surface.inside = 0;
  Material glass = surface;
  glass.id = "glass", glass.inside = kNone;
  scene->materials = {material("bed", lambert(bay.bed ? 0.3 : 0)), surface, glass};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -bay.depth}));
  if (bay.high > 0) {
    scene->meshes = {waves(static_cast<uint32_t>(2 * bay.wide) + 1, -bay.wide / 2, bay.high, 4, 1)};
    scene->groups[0].placements.push_back({{}, TargetKind::mesh, 0, kNone, kNone});
  } else {
    place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  }
  if (bay.layers) add_layers(*scene, bay);
  if (bay.haze) add_haze(*scene);
  if (bay.mirrors) add_mirrors(*scene);
  if (bay.upright)
    for (Placement& p : scene->groups[0].placements) p.to_parent = kUpright * p.to_parent;
  if (ball) place(*scene, PrimitiveKind::sphere, {0.1}, 2, translation({3e4, 0, 3}));
  check_scene(*scene, "bay");
  return scene;
}

Rendered run_of(const Bay& bay, bool ball, uint32_t paths) {
  AirSpec air;
  air.profile = standard_profile("tropical");
  air.aerosol = AirSpec::Aerosol{};
  air.adjacency = false;
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  sources.add(SunSpec{dir_from_angles(40 * kDegree, 0.3), 0.27 * kDegree, Curve::constant(1)});
  Dir view = dir_from_angles(25 * kDegree, 2);
  if (bay.upright) view = kUpright.vector(view);
  const std::vector<Band> blue{Band::rectangular("blue", 0.45, 0.002)};
  auto r = render(scene_with(bay, ball), sources,
                  std::make_unique<RaySensor>(repeated({view * 20, -view, 0}), blue, paths, 0.02));
  EXPECT_EQ(r.report.statistics.failures, 0u);
  return r;
}

Repeated look(const Bay& bay, bool ball, uint32_t paths) { return over_problems(run_of(bay, ball, paths).result, 0); }

// Paths that ask: as many as resolve the bound of each case below, with which a deviation of 3.5 of its errors (p =
// 5e-4) is seen, and in the first case the 2 % that a twentieth more of the sky's density makes. So many times as many
// in the long run.
constexpr uint32_t kLonger = 64;

// What chance finds takes four fifths of the time, so it is stored with its standard error, of kMore times the paths
// that took as long. SUITE_LONG finds it anew, prints it as it stands in the tables below, and holds it against them.
constexpr uint32_t kMore = 4;
bool is_long() { return std::getenv("SUITE_LONG") != nullptr; }
template <class Find>
Repeated by_chance(const char* name, const Repeated& stored, const Find& find) {
  if (!is_long()) return stored;
  const Repeated found = find();
  std::printf("%s: {%.6g, %.3g}\n", name, found.mean, found.error);
  EXPECT_NEAR(found.mean, stored.mean, 3.5 * std::hypot(found.error, stored.error))
      << name << ": where paths by chance are meant to change, store what is printed above";
  return found;
}

void print(const char* name, const Repeated& asked, const Repeated& chance) {
  std::printf("%s: asked for %.5g +- %.2f %%, by chance %.5g +- %.2f %%, %+.2f %%\n", name, asked.mean,
              100 * asked.error / asked.mean, chance.mean, 100 * chance.error / chance.mean,
              100 * (asked.mean / chance.mean - 1));
}

// Over a bed, which asks; where only the water's own scatterings do; under waves that focus on the bed, through
// which light from there comes in one way, in several, or in ways that are not found; a sheet so small that most light
// comes in beside it, where water has no surface and so does not scatter; one that stands upright, before which
// there is air below the horizon as well: of the sky only what is above is drawn, so what chance brings from below must
// not count as asked for; deep clear water, where the product of a chain's ways does not fit into a float; layers,
// which chains pass; and a body of haze over the water, which the sky's light passes.
TEST(WaterChain, FindsOfTheSkyWhatChanceFinds) {
  const struct {
    const char* name;
    Bay bay;
    uint32_t paths, by_chance;
    double bound;
    Repeated chance;
    bool quieter = false;  // than as many paths by chance: what it is for; waves that focus make noise of the sun
    double darker = 0;     // negative control: water that absorbs more
  } cases[] = {{"bed", {}, 64, 512, 0.01, {0.0227714, 2.41e-05}, true, 0.055},
               {"black bed", {.bed = false}, 5, 128, 0.03, {0.00288543, 1.95e-05}, true},
               {"waves", {.high = 0.3}, 32, 192, 0.02, {0.0185025, 7.84e-05}, false, 0.06},
               {"small sheet", {.high = 0.01, .wide = 6}, 28, 256, 0.01, {0.0560159, 9.34e-05}},
               {"upright", {.upright = true}, 24, 256, 0.02, {0.022831, 4.08e-05}},
               {"deep", {.absorption = 0.0005, .scattering = 0.004, .depth = 800}, 6, 192, 0.02, {0.0150366, 4.3e-05}},
               {"layers", {.layers = true}, 32, 256, 0.01, {0.0194991, 4.01e-05}, true},
               {"haze", {.haze = true}, 40, 256, 0.025, {0.0190488, 0.000104}}};
  for (const auto& c : cases) {
    const Repeated asked = look(c.bay, false, c.paths * (is_long() ? kLonger : 1)),
                   chance = by_chance(c.name, c.chance, [&] { return look(c.bay, true, c.by_chance * kMore); });
    const double error = std::hypot(asked.error, chance.error);
    print(c.name, asked, chance);
    EXPECT_NEAR(asked.mean, chance.mean, 3.5 * error) << c.name;  // p = 5e-4
    EXPECT_LT(error, c.bound * chance.mean) << c.name;
    if (c.quieter) {
      const double times = double{kMore} * c.by_chance / (c.paths * (is_long() ? kLonger : 1));
      EXPECT_LT(asked.error, 0.8 * std::sqrt(times) * chance.error) << c.name;
    }
    if (c.darker == 0) continue;
    Bay dark = c.bay;
    dark.absorption = c.darker;
    const Repeated darker = look(dark, false, c.paths);
    EXPECT_GT(chance.mean - darker.mean, 3.5 * std::hypot(darker.error, chance.error)) << c.name;
  }
}

// Under suns alone. asked: they are, through the surface.
Rendered under_suns(const Bay& bay, std::span<const SunSpec> suns, bool asked, uint32_t paths) {
  SourceSpecs sources;
  for (const SunSpec& sun : suns) sources.add(sun);
  PipelineOptions options;
  options.refracted_sources = asked;
  const Dir view = dir_from_angles(25 * kDegree, 2);
  const std::vector<Band> blue{Band::rectangular("blue", 0.45, 0.002)};
  return render(scene_with(bay), sources,
                std::make_unique<RaySensor>(repeated({view * 20, -view, 0}), blue, paths, 0.02), options);
}
Repeated look_up(const Bay& bay, std::span<const SunSpec> suns, bool asked, uint32_t paths) {
  return over_problems(under_suns(bay, suns, asked, paths).result, 0);
}
SunSpec sun_of(double azimuth, double half_angle_deg) {
  return {dir_from_angles(40 * kDegree, azimuth), half_angle_deg * kDegree, Curve::constant(1)};
}

// The sun itself, so wide that chance finds it often: with a bed, which asks along chains; without one, where only the
// water's own scatterings ask; and with a bed that mirrors in part: what it mirrors it asks for nowhere.
TEST(WaterChain, FindsOfTheSunWhatChanceFinds) {
  const SunSpec wide[] = {sun_of(0.3, 20)};
  // Seen once of 4096 times the paths asked for, 16 times those by chance: -0.08 % +- 0.07 with, +0.7 % +- 0.5 without.
  const struct {
    const char* name;
    Bay bay;
    uint32_t paths;
    double bound;
    Repeated chance;
  } cases[] = {{"bed", {}, 24, 0.01, {0.0260847, 7.51e-05}},
               {"black bed", {.bed = false}, 16, 0.05, {0.00143626, 2.25e-05}},
               {"bed that mirrors", {.mirrors = true}, 600, 0.01, {0.0426754, 0.000116}}};
  for (const auto& c : cases) {
    const Repeated asked = look_up(c.bay, wide, true, c.paths * (is_long() ? kLonger : 1)),
                   chance = by_chance(c.name, c.chance, [&] { return look_up(c.bay, wide, false, 16384 * kMore); });
    const double error = std::hypot(asked.error, chance.error);
    print(c.name, asked, chance);
    EXPECT_NEAR(asked.mean, chance.mean, 3.5 * error);
    EXPECT_LT(error, c.bound * chance.mean);
    if (!c.bay.bed || c.bay.mirrors) continue;
    // Negative control: water that absorbs a tenth more.
    const Repeated darker = look_up({.absorption = 0.055}, wide, true, c.paths);
    EXPECT_GT(chance.mean - darker.mean, 3.5 * std::hypot(darker.error, chance.error));
  }
}

// Chains look for one of two suns, and claim that one's light alone.
TEST(WaterChain, LightOfTwoSunsAddsUp) {
  const SunSpec suns[] = {sun_of(0.3, 0.27), sun_of(2.5, 0.27)};
  const std::span<const SunSpec> both(suns);
  const Repeated one = look_up({}, both.first(1), true, 96), other = look_up({}, both.last(1), true, 96),
                 all = look_up({}, both, true, 96);
  const double error = std::hypot(all.error, one.error, other.error);
  std::printf("%.5g + %.5g, together %.5g, +- %.2f %%\n", one.mean, other.mean, all.mean, 100 * error / all.mean);
  EXPECT_NEAR(all.mean, one.mean + other.mean, 3.5 * error);  // p = 5e-4
  EXPECT_LT(error, 0.01 * all.mean);                          // negative control: what is counted twice is 0.2 or more
}

// What leaves water beside its surface is told; nothing is where planes go on for ever.
TEST(WaterChain, TellsOfASheetThatEndsInTheOpen) {
  const Bay open{.high = 0.01, .wide = 6}, endless{.layers = true};
  const SunSpec suns[] = {sun_of(0.3, 0.27)};
  const std::string said =
      line_of(diagnose_leaks(under_suns(open, suns, true, 16).report.statistics, *scene_with(open)).value());
  EXPECT_THAT(said, testing::AllOf(testing::HasSubstr("have no boundary"), testing::HasSubstr("[DR204]")));
  const RunStatistics whole = under_suns(endless, suns, true, 16).report.statistics;
  EXPECT_EQ(whole.strayed, 0.0);
  EXPECT_FALSE(diagnose_leaks(whole, *scene_with(endless)).has_value());
}

// A grid of waves with vertex normals: one way through calm ones, unknown where they focus above the place, below the
// horizon's light and on a steep sea; none from above.
TEST(WaterChain, KnowsWhereThereIsOneWay) {
  const auto sheet = [](double height, double length) {
    const Mesh mesh = waves(65, 0, height, length, 0);
    const auto scene = scene_of({mesh}, {material("surface", lambert(0))});
    const Tracer tracer(scene);
    return RefractingSheet::of(tracer, 0, tracer.object(0));
  };
  using Ways = RefractingSheet::Ways;
  const Dir sun = dir_from_angles(35 * kDegree, 0), low = dir_from_angles(89 * kDegree, 0);
  const auto calm = sheet(0.02, 8);
  ASSERT_TRUE(calm.has_value());
  EXPECT_EQ(calm->ways({16, 16, -8}, sun, kIndex), Ways::one);
  EXPECT_EQ(calm->ways({16, 16, -800}, sun, kIndex), Ways::unknown) << "below where waves focus light";
  EXPECT_EQ(calm->ways({16, 16, -8}, low, kIndex), Ways::unknown);
  EXPECT_EQ(calm->ways({16, 16, 1}, sun, kIndex), Ways::none);
  EXPECT_EQ(calm->ways({16, 16, 0}, sun, kIndex), Ways::unknown);
  EXPECT_EQ(calm->ways_between({16, 16, -8}, {16, 16, -1}), Ways::unknown) << "a wave may throw light into the next";
  const auto steep = sheet(0.5, 4);
  EXPECT_TRUE(!steep || steep->ways({16, 16, -8}, sun, kIndex) == Ways::unknown);
}

// Between places over and under a plane there is one way, and none between places on one side of it, however it lies.
TEST(WaterChain, KnowsWhereThereIsOneWayToALamp) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("surface", lambert(0))};
  const Dir up = normalized(Vec3{0.3, 0.1, 1}), along = normalized(cross({0, 1, 0}, up)), aside = cross(up, along);
  const Affine3 tilted{{along.x, aside.x, up.x, along.y, aside.y, up.y, along.z, aside.z, up.z}, {3, 0, 2}};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, tilted);
  const Tracer tracer(scene);
  const auto flat = RefractingSheet::of(tracer, 0, tracer.object(0));
  ASSERT_TRUE(flat.has_value());
  using Ways = RefractingSheet::Ways;
  const Vec3 over = Vec3{3, 0, 2} + up * 0.5, under = Vec3{13, -4, 2} - up * 9.0;
  EXPECT_EQ(flat->ways_between(over, over + along * 9.0), Ways::none);
  EXPECT_EQ(flat->ways_between(under, under - up), Ways::none);
  EXPECT_EQ(flat->ways_between(over, under - up * 4.0), Ways::one);
}

}  // namespace
}  // namespace suite::test::water_chain_test
