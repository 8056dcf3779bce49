// Each technique of light transport off (technique_switches.h): what is left brings the same light in the mean.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "tests/support/media_kit.h"
#include "transport/technique_switches.h"

namespace suite::test::ablation_test {
namespace {

using Make = std::shared_ptr<Scene> (*)();
const Dir kToSun = dir_from_angles(40 * kDegree, 0.3), kAside = normalized(Vec3{kToSun.x, kToSun.y, 0});

// A bed under 4 m of water. mirrors: half of the bed is one.
std::shared_ptr<Scene> water(bool mirrors) {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.05), Curve::constant(0.25), hg(0.9))};
  scene->media[0].index = Curve::constant(1.34);
  Material surface = material("surface", {"dielectric", {}, {{"index", Curve::constant(1.34)}}, {}, nullptr});
  surface.inside = 0;
  scene->materials = {material("bed", lambert(0.3)), surface};
  if (mirrors) {
    scene->materials.push_back(material("white", lambert(0.3)));
    scene->materials.push_back(
        material("mirror", {"mirror", {}, {{"reflectance", Curve::constant(0.9)}}, {}, nullptr}));
    PropertyMap shares;
    shares.name = "shares", shares.width = shares.height = 1, shares.channels = 2;
    shares.values = {0.5f, 0.5f}, shares.materials = {2, 3};
    scene->property_maps = {shares}, scene->property_bindings = {{0, 0}};
  }
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -4}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  check_scene(*scene, "water");
  return scene;
}
std::shared_ptr<Scene> pool() { return water(false); }
std::shared_ptr<Scene> pool_of_mirrors() { return water(true); }

std::shared_ptr<Scene> cloud() {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.1), Curve::constant(3), hg(0.85))};
  scene->materials = {material("ground", lambert(0.6)), boundary(0)};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -1.5}));
  place(*scene, PrimitiveKind::sphere, {0.8}, 1);
  check_scene(*scene, "cloud");
  return scene;
}

// A ball of rough metal throws light on the ground that is looked at.
std::shared_ptr<Scene> ball() {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("ground", lambert(0.5)),
                      material("ball", {"ggx", {{"roughness", 0.1}}, {{"f0", Curve::constant(0.9)}}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {40, 40}, 0);
  place(*scene, PrimitiveKind::sphere, {1}, 1, translation({-1.6 * kAside.x, -1.6 * kAside.y, 1}));
  check_scene(*scene, "ball");
  return scene;
}

struct Case {
  const char* technique;
  Make scene;
  double half_angle_deg;        // of the sun
  uint32_t paths, paths_after;  // with, and without it
};

Repeated look(const Case& c, bool off) {
  SourceSpecs sources;
  sources.add(SunSpec{kToSun, c.half_angle_deg * kDegree, Curve::constant(1)});
  PipelineOptions options;
  if (off) technique_of(c.technique)->off(options);
  const Dir view = dir_from_angles(25 * kDegree, 2);
  const std::vector<Band> blue{Band::rectangular("blue", 0.45, 0.002)};
  auto r = render(
      c.scene(), sources,
      std::make_unique<RaySensor>(repeated({view * 20, -view, 0}), blue, off ? c.paths_after : c.paths, 0.02), options);
  EXPECT_EQ(r.report.statistics.failures, 0u);
  return over_problems(r.result, 0);
}

TEST(Ablation, MeansAreThoseWithoutATechnique) {
  // As many paths as the control needs: 4 errors are up to 8 % of the light.
  const Case cases[] = {{"light_sampling", cloud, 20, 128, 1024}, {"manifold", pool, 20, 16, 1280},
                        {"volume_chains", pool, 20, 16, 128},     {"volume_chains", pool_of_mirrors, 20, 320, 320},
                        {"side_vertex", cloud, 0.27, 128, 256},   {"caustic_guide", ball, 2, 16, 96}};
  for (const Case& c : cases) {
    const Repeated with = look(c, false), without = look(c, true);
    const double error = std::hypot(with.error, without.error);
    std::printf("%s: %.5g +- %.2f %%, off %.5g +- %.2f %%, %+.2f %%\n", c.technique, with.mean,
                100 * with.error / with.mean, without.mean, 100 * without.error / without.mean,
                100 * (without.mean / with.mean - 1));
    EXPECT_NEAR(with.mean, without.mean, 4 * error) << c.technique;  // p = 6e-5
    // Negative control: a tenth more light would be seen (light adds up: the same paths of a brighter sun).
    EXPECT_GT(std::fabs(1.1 * with.mean - without.mean), 4 * error) << c.technique;
  }
}

}  // namespace
}  // namespace suite::test::ablation_test
