// The albedo of scenes for even light from above.
#include "scheduler/scene_albedo.h"

#include <gtest/gtest.h>

#include "support/radiometry_kit.h"

namespace suite::test {
namespace {

Material grey(const std::string& id, double reflectance) { return material(id, lambert(reflectance)); }

std::shared_ptr<Scene> bounded(std::vector<Mesh> meshes, std::vector<Material> materials) {
  auto scene = scene_of(std::move(meshes), std::move(materials));
  scene->bounds = scene_bounds(*scene);
  return scene;
}

SceneAlbedo albedo_of(const std::shared_ptr<Scene>& scene) {
  const Tracer tracer(scene);
  const Optics optics(*scene, make_state(std::vector<Band>{Band::rectangular("b", 0.55, 0.01)}, 1));
  return scene_albedo(tracer, optics, 0);
}

// A square that faces up.
Mesh square(double half, double x, double z, uint32_t material) {
  return mesh_of({{x - half, -half, z}, {x + half, -half, z}, {x + half, half, z}, {x - half, half, z}},
                 {0, 1, 2, 0, 2, 3}, material);
}

TEST(SceneAlbedo, OfAPlainIsItsReflectance) {
  const SceneAlbedo albedo = albedo_of(bounded({square(50, 0, 0, 0)}, {grey("ground", 0.37)}));
  ASSERT_EQ(albedo.of_bins.size(), 1u);
  EXPECT_NEAR(albedo.of_bins[0], 0.37, 1e-4);
}

TEST(SceneAlbedo, OfTwoHalvesIsTheirMean) {
  const SceneAlbedo albedo =
      albedo_of(bounded({square(50, -50, 0, 0), square(50, 50, 0, 1)}, {grey("dark", 0.1), grey("bright", 0.7)}));
  EXPECT_GT(albedo.error, 0.001);
  EXPECT_NEAR(albedo.of_bins[0], 0.4, 4 * albedo.error + 0.01);
}

TEST(SceneAlbedo, ShadedGroundDoesNotCount) {
  const SceneAlbedo albedo =
      albedo_of(bounded({square(50, 0, 0, 0), square(50, 0, 0.1, 1)}, {grey("ground", 0.9), grey("roof", 0.2)}));
  EXPECT_NEAR(albedo.of_bins[0], 0.2, 0.01);
}

TEST(SceneAlbedo, NothingIsNoAlbedo) {
  auto scene = bounded({square(50, 0, 0, 0)}, {grey("ground", 0.5)});
  scene->bounds = {};
  scene->bounds.grow(Vec3{1e6, 1e6, 0});
  const Tracer tracer(scene);
  const Optics optics(*scene, make_state(std::vector<Band>{Band::rectangular("b", 0.55, 0.01)}, 1));
  EXPECT_TRUE(scene_albedo(tracer, optics, 0).of_bins.empty());
  auto air = std::make_shared<AirSpec>();
  air->ground_of_any_scene = true;
  EXPECT_EQ(over_scene(air, tracer, optics, 0), air);
  air->ground_of_scene = true;
  EXPECT_THROW(over_scene(air, tracer, optics, 0), Error);
}

TEST(SceneAlbedo, AirGetsIt) {
  auto scene = bounded({square(50, 0, 0, 0)}, {grey("ground", 0.37)});
  const Tracer tracer(scene);
  const Optics optics(*scene, make_state(std::vector<Band>{Band::rectangular("b", 0.55, 0.01)}, 1));
  auto air = std::make_shared<AirSpec>();
  EXPECT_EQ(over_scene(air, tracer, optics, 0), air);
  air->ground_of_any_scene = true;
  EXPECT_NEAR(over_scene(air, tracer, optics, 0)->ground_albedo.at(0.55), 0.37, 1e-4);
}

}  // namespace
}  // namespace suite::test
