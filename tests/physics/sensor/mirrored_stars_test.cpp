// Stars in flat smooth surfaces: each image is where the mirror has it and as bright as Fresnel's equations say, panes
// let stars through, and what is left to chance is left once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "optics/fresnel.h"
#include "support/media_kit.h"
#include "support/stars_kit.h"

namespace suite::mirrored_stars_test {
namespace {

using namespace test;

constexpr double kIndex = 1.5;
ModelSpec smooth(double index) { return {"dielectric", {}, {{"index", Curve::constant(index)}}, {}, nullptr}; }
ModelSpec mirror(double reflectance) {
  return {"mirror", {}, {{"reflectance", Curve::constant(reflectance)}}, {}, nullptr};
}
double fresnel(double cosine) { return fresnel_dielectric(cosine, kIndex).reflectance; }

// Level, wide, in front of a camera that stands 2 m over it; its bed is black.
std::shared_ptr<Scene> lake(const ModelSpec& water) {
  return scene_of({quad(9000, 0, 0), quad(9000, -5, 1)}, {material("water", water), material("bed", lambert(0))});
}
// A board of glass of 2 m before the camera, across the line to the star but turned by an angle (rad).
Mesh board(Dir star, double turned, double thickness, uint32_t material) {
  const Frame f = Frame::around(star);
  const Dir z = normalized(f.z * std::cos(turned) + f.x * std::sin(turned)), y = f.y, x = cross(y, z);
  const Vec3 middle = Vec3{0, 0, 2} + star * 10;
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i)
    v.push_back(middle + x * (i & 1 ? 2.0 : -2.0) + y * (i & 2 ? 2.0 : -2.0) + z * (i & 4 ? thickness : 0.0));
  const Mesh shape = box({0, 0, 0}, {1, 1, 1}, material, true);
  return mesh_of(v, {shape.indices.begin(), shape.indices.end()}, material);
}
std::string at(Dir star, double right = 0, double up = 0, const std::string& more = {}) {
  std::string text = camera(star, right, up, more);
  return text.replace(text.find("paths: 4"), 8, "paths: 1");
}
Dir star_now() { return sphere().without_air(kStar.place); }
Dir in_water(Dir d) { return {d.x, d.y, -d.z}; }

TEST(MirroredStars, WaterHasFresnelsShare) {
  const Dir star = star_now();
  PlatformKit kit;
  kit.render(lake(smooth(kIndex)), stars_alone({kStar}), at(in_water(star), 30.3 * kStep, -20.2 * kStep));
  std::printf("energy over Fresnel's share - 1: %.1e\n",
              energy(kit.shots[0], 1e4) / (fresnel(star.z) * above(kStar)) - 1);
  EXPECT_NEAR(energy(kit.shots[0], 1e4) / (fresnel(star.z) * above(kStar)), 1, 1e-4);
  const std::vector<Listed> seen = table_of(kit.shots[0]);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_NEAR(seen[0].irradiance / (fresnel(star.z) * above(kStar)), 1, 1e-4);
  EXPECT_NEAR(std::hypot(seen[0].column - 100, seen[0].row - 100),
              std::hypot(std::tan(30.3 * kStep), std::tan(20.2 * kStep)) / kStep, 0.8);
  EXPECT_GT(std::fabs(fresnel(star.z) / fresnel(0.5 * star.z) - 1), 0.01) << "the angle must be noticed";
  // Both the star and its image, by a camera that sees both.
  PlatformKit wide;
  std::string text = at({star.x, star.y, 0.0}, 0, 0);
  text.replace(text.find("focal_length_mm: 100"), 20, "focal_length_mm: 0.5");
  wide.render(lake(mirror(0.7)), stars_alone({kStar}), text);
  const std::vector<Listed> both = table_of(wide.shots[0]);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NEAR(both[1].irradiance / both[0].irradiance, 0.7, 1e-4);
}

// Trails turn with the sky in the water as well, and keep their light.
TEST(MirroredStars, TrailsInWater) {
  const Dir star = star_now();
  PlatformKit kit;
  kit.render(lake(mirror(1)), stars_alone({kStar}), at(in_water(star), 0, 0, "time_s: 0\nintegration_time_s: 100\n"));
  EXPECT_NEAR(energy(kit.shots[0], 1e4) / above(kStar), 1, 1e-4);
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  const CaptureResult& r = kit.shots[0].result;
  for (size_t p = 0; p < r.problems(); ++p) {
    if (!(r.radiance[p] > 0)) continue;
    const auto x = static_cast<double>(p % r.columns), y = static_cast<double>(p / r.columns);
    left = std::min(left, x), right = std::max(right, x), top = std::min(top, y), bottom = std::max(bottom, y);
  }
  EXPECT_NEAR(std::hypot(right - left, bottom - top), 100 * 7.292115e-5 * std::cos(kStar.place.declination) / kStep, 2);
}

// A pane passes (1 - R)^2 at both faces; what runs to and fro between them is left to chance.
TEST(MirroredStars, PanesLetThemThrough) {
  const Dir star = star_now();
  for (const double turned : {0.0, 0.7}) {
    PlatformKit kit;
    kit.render(scene_of({board(star, turned, 0.01, 0)}, {material("glass", smooth(kIndex))}), stars_alone({kStar}),
               at(star));
    const double R = fresnel(std::cos(turned)), once = (1 - R) * (1 - R);
    const std::vector<Listed> seen = table_of(kit.shots[0]);
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_NEAR(seen[0].irradiance / above(kStar), once, 1e-4) << turned;
  }
}

// Both faces of a pane mirror the star: R + R (1 - R)^2 of it.
TEST(MirroredStars, PanesMirrorAtBothFaces) {
  const Dir star = star_now();
  const Frame f = Frame::around(star);
  const double turned = 0.9;
  const Dir normal = normalized(f.z * std::cos(turned) + f.x * std::sin(turned));
  const Dir image = star - normal * (2 * dot(star, normal));
  // The camera stands before the pane on the star's side.
  const Dir z = normal, y = f.y, x = cross(y, z);
  const Vec3 middle = Vec3{0, 0, 2} + image * 10;
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i)
    v.push_back(middle + x * (i & 1 ? 2.0 : -2.0) + y * (i & 2 ? 2.0 : -2.0) - z * (i & 4 ? 0.0 : 0.01));
  const Mesh shape = box({0, 0, 0}, {1, 1, 1}, 0, true);
  PlatformKit kit;
  kit.render(
      scene_of({mesh_of(v, {shape.indices.begin(), shape.indices.end()}, 0)}, {material("glass", smooth(kIndex))}),
      stars_alone({kStar}), at(image));
  const double R = fresnel(std::fabs(dot(star, normal)));
  const std::vector<Listed> seen = table_of(kit.shots[0]);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_NEAR(seen[0].irradiance / above(kStar), R + R * (1 - R) * (1 - R), 1e-4);
}

// Cells of 3 degrees no longer shine in what has images of its stars: the one pixel of the image is all there is. In a
// curved mirror they do, and none is listed there.
TEST(MirroredStars, NoneIsCountedTwice) {
  const Dir star = star_now();
  const auto beside = [&](const std::shared_ptr<Scene>& scene, size_t listed) {
    PlatformKit kit;
    kit.render(scene, stars_alone({kStar}), at(in_water(star), 30 * kStep, 0));
    EXPECT_EQ(table_of(kit.shots[0]).size(), listed);
    const std::vector<double>& L = kit.shots[0].result.radiance;
    return std::count_if(L.begin(), L.end(), [](double v) { return v > 0; });
  };
  EXPECT_EQ(beside(lake(mirror(1)), 1), 1);
  std::vector<Vec3> v;
  std::vector<uint32_t> faces;
  for (uint32_t j = 0; j < 41; ++j)
    for (uint32_t i = 0; i < 41; ++i) {
      const double x = (i - 20.0) * 10, y = (j - 20.0) * 10;
      v.push_back({x, y, -1e-6 * (x * x + y * y)});
      if (i < 40 && j < 40)
        faces.insert(faces.end(),
                     {41 * j + i, 41 * j + i + 1, 41 * j + i + 42, 41 * j + i, 41 * j + i + 42, 41 * j + i + 41});
    }
  EXPECT_GT(beside(scene_of({mesh_of(v, faces, 0)}, {material("mirror", mirror(1))}), 0), 1000) << "a cell";
}

// Something on the way from the mirror to the star, or no mirror where the image would be.
TEST(MirroredStars, ImagesAreHidden) {
  const Dir star = star_now();
  const auto seen = [&](std::vector<Mesh> meshes) {
    PlatformKit kit;
    kit.render(scene_of(std::move(meshes), {material("mirror", mirror(1)), material("wall", lambert(0.3))}),
               stars_alone({kStar}), at(in_water(star)));
    return table_of(kit.shots[0]).size();
  };
  const Vec3 foot{2 * star.x / star.z, 2 * star.y / star.z, 0};
  const Vec3 on_way = foot + star * 20;
  const Mesh wall = box(on_way - Vec3{1, 1, 1}, on_way + Vec3{1, 1, 1}, 1, true);
  EXPECT_EQ(seen({quad(50, 0, 0)}), 1u);
  EXPECT_EQ(seen({quad(50, 0, 0), wall}), 0u);
  EXPECT_EQ(seen({quad(0.1, 0, 0), quad(50, -0.1, 1)}), 0u);
}

// Where surfaces have no images, a run says so once, with the surfaces and how bright what is left out is; where all
// have, or no star is a point, it says nothing.
TEST(MirroredStars, SurfacesWithoutImagesAreNamed) {
  const Dir star = star_now();
  const auto told = [&](const std::shared_ptr<Scene>& scene, bool in_view, const std::string& more) {
    SourceSpecs sources = stars_alone({kStar}, in_view);
    PlatformKit kit;
    std::vector<std::unique_ptr<Sensor>> sensors;
    sensors.push_back(kit.make(at(in_water(star)) + more));
    JobOptions job;
    job.progress = false;
    std::string said;
    job.diagnose = [&](const Diagnostic& d) {
      if (d.code == Dr::caustics_not_found) said += line_of(d);
    };
    run_job(scene, sources, sensors, job);
    return said;
  };
  auto ball = lake(mirror(1));
  ball->materials.push_back(material("ball", mirror(0.5)));
  place(*ball, PrimitiveKind::sphere, {0.1}, static_cast<uint32_t>(ball->materials.size() - 1), translation({0, 0, 9}));
  check_scene(*ball, "ball");
  EXPECT_THAT(told(ball, true, ""),
              testing::AllOf(testing::HasSubstr("stars and planets (1)"),
                             testing::HasSubstr("('ball') that are curved"), testing::HasSubstr("[DR207]")));
  EXPECT_EQ(told(ball, false, ""), "");
  EXPECT_EQ(told(lake(mirror(1)), true, ""), "");
  EXPECT_THAT(told(lake(mirror(1)), true, "stokes: linear\n"), testing::HasSubstr("('water') seen by a polarimeter"));
}

}  // namespace
}  // namespace suite::mirrored_stars_test
