// The albedo of scenes for even light from above.
#include "scheduler/scene_albedo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/radiometry_kit.h"

namespace suite::test::scene_albedo_test {
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

// An open box whose red walls mirror: light that is reflected to and fro, at four hero wavelengths. The values are
// those of paths that draw their hero wavelength anew at every surface and end below a thousandth (the walk before this
// one), with a standard error of 0.004 on the mean of the bins.
TEST(SceneAlbedo, OfAnOpenBoxIsThatOfPathsThatDrawAnewAtEverySurface) {
  const double before[] = {0.10550, 0.14581, 0.41398, 0.62903}, error = 0.00404;
  const Curve red({0.4, 0.5, 0.6, 0.7}, {0.2, 0.3, 0.8, 0.9}, Outside::hold);
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i) v.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.5 : 0.0});
  const auto scene = bounded(
      {mesh_of(v, {0, 1, 2, 1, 3, 2, 0, 4, 1, 1, 4, 5, 2, 3, 6, 3, 7, 6, 0, 2, 4, 2, 6, 4, 1, 5, 3, 3, 5, 7}, 0)},
      {material("walls",
                {"ward", {{"roughness", 0.25}}, {{"diffuse", red}, {"specular", Curve::constant(0.1)}}, {}, nullptr})});
  const Tracer tracer(scene);
  std::vector<Band> bands;
  for (int i = 0; i < 4; ++i) bands.push_back(Band::rectangular("b", 0.42 + 0.08 * i, 0.01));
  const Optics optics(*scene, make_state(bands, 0.01, 0, 4));
  const SceneAlbedo albedo = scene_albedo(tracer, optics, 0);
  ASSERT_EQ(albedo.of_bins.size(), 4u);
  double mean = 0, mean_before = 0;
  for (size_t b = 0; b < 4; ++b) mean += double{albedo.of_bins[b]} / 4, mean_before += before[b] / 4;
  EXPECT_NEAR(mean, mean_before, 4 * std::hypot(error, albedo.error));
  EXPECT_LT(albedo.error, 1.2 * error);
  // Negative control: walls that mirror a tenth less would be seen.
  EXPECT_GT(0.1 * mean, 4 * std::hypot(error, albedo.error));
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
}  // namespace suite::test::scene_albedo_test
