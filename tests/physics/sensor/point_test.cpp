// Point collectors against closed forms: irradiance of a plane holds the direct light of Sun and lamps, collimated or
// not, beside the diffuse one; actinic flux collects from everywhere alike; what stands in the way takes it away.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "light/kinds/lamps.h"
#include "support/media_kit.h"
#include "support/platform_kit.h"

namespace suite::point_test {
namespace {

using test::PlatformKit;

constexpr double kSun = 1500, kSky = 60, kGround = 0.3, kZenith = 35 * kDegree;

SourceSpecs sun_and_sky(double half_angle, bool sky = true) {
  SourceSpecs s;
  s.add(SunSpec{{{std::sin(kZenith), 0, std::cos(kZenith)}, half_angle, Curve::constant(kSun)}});
  if (sky) s.add(test::uniform_sky(kSky, false));
  return s;
}
// A wide Lambertian plane at z = 0.
std::shared_ptr<Scene> plain() {
  auto scene = std::make_shared<Scene>();
  scene->materials = {test::material("ground", test::lambert(kGround)), test::material("black", test::lambert(0))};
  test::place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  check_scene(*scene, "plain");
  return scene;
}
std::string collectors(const std::string& list, int paths) {
  return strf("kind: point\npaths: %d\nbands: [{name: b, center_um: 0.55, fwhm_um: 0.01, shape: rectangular}]\n",
              paths) +
         "collectors:\n" + list;
}
const std::string kSet =
    "  - {quantity: irradiance, position_m: [0, 0, 2], normal: [0, 0, 1]}\n"
    "  - {quantity: irradiance, position_m: [0, 0, 2], normal: [0, 0, -1]}\n"
    "  - {quantity: irradiance, position_m: [0, 0, 2], normal: [1, 0, 0]}\n"
    "  - {quantity: actinic_flux, position_m: [0, 0, 2]}\n"
    "  - {quantity: radiance, position_m: [0, 0, 2], look: [0, 0, -1]}\n";

// What the five collectors of kSet read over the plain. Light of a disk adds up to more in a sphere than on a plane
// that faces the disk's middle: solid angle over projected solid angle.
std::vector<double> expected(double half_angle) {
  const double direct = kSun * std::cos(kZenith), down = direct + kPi * kSky, ground = kGround * down / kPi;
  return {down, kPi * ground, kSun * std::sin(kZenith) + kPi / 2 * (kSky + ground),
          kSun * 2 / (1 + std::cos(half_angle)) + 2 * kPi * (kSky + ground), ground};
}

TEST(Point, DirectAndDiffuseLightOfACollimatedSun) {
  PlatformKit kit;
  kit.render(plain(), sun_and_sky(0), collectors(kSet, 4096));
  const CaptureResult& r = kit.shots.at(0).result;
  const std::vector<double> want = expected(0);
  const char* names[] = {"down", "up", "towards the sun's side", "actinic flux", "radiance"};
  for (size_t i = 0; i < want.size(); ++i) {
    std::printf("%-24s %9.4f, closed form %9.4f, standard error %.4f\n", names[i], r.radiance[i], want[i],
                r.standard_error[i]);
    // Quasi-random points do better than the standard error says; uniform light leaves no error but rounding.
    EXPECT_NEAR(r.radiance[i], want[i], 3 * r.standard_error[i] + 2e-6 * want[i]) << names[i];
    EXPECT_LT(r.standard_error[i], 1e-3 * want[i]) << names[i];
  }
  // Truth tells of what is met, not of the collector: its material is the ground's.
  const auto& names_of = r.truth_names;
  const size_t material =
      static_cast<size_t>(std::find(names_of.begin(), names_of.end(), "material") - names_of.begin());
  ASSERT_LT(material, names_of.size());
  EXPECT_EQ(r.truth[1 * names_of.size() + material], 0);
  EXPECT_TRUE(std::isnan(r.truth[0 * names_of.size() + material]));
}

// The disk of the Sun may be met by chance, too; both ways share it and it counts once.
TEST(Point, ASunWithADiskCountsOnce) {
  for (const double half_angle : {0.00465, 0.2}) {
    PlatformKit kit;
    kit.render(plain(), sun_and_sky(half_angle), collectors(kSet, 4096));
    const CaptureResult& r = kit.shots.at(0).result;
    const std::vector<double> want = expected(half_angle);
    for (size_t i : {0u, 1u, 2u, 3u}) EXPECT_NEAR(r.radiance[i], want[i], 2e-3 * want[i]) << half_angle << " " << i;
  }
}

TEST(Point, WhatStandsInTheWayTakesTheDirectLight) {
  auto scene = plain();
  // A black disk of radius 0.5 towards the sun, 3 m away: it takes the sun and a little of the sky.
  test::place(*scene, PrimitiveKind::disk, {0.5, 0}, 1,
              translation(Vec3{3 * std::sin(kZenith), 0, 2 + 3 * std::cos(kZenith)}));
  check_scene(*scene, "shaded");
  PlatformKit kit;
  kit.render(scene, sun_and_sky(0, false), collectors(kSet, 4096));
  // Without a sky, what is left upwards is nothing, downwards the ground's light but for its own shadow's.
  EXPECT_EQ(kit.shots.at(0).result.radiance[0], 0);
  EXPECT_NEAR(kit.shots.at(0).result.radiance[1], kGround * kSun * std::cos(kZenith), 0.1 * kGround * kSun);
}

TEST(Point, LampsObeyTheInverseSquareAndTheCosine) {
  auto scene = std::make_shared<Scene>();
  scene->groups.push_back({"root", {}});
  check_scene(*scene, "nothing");
  SourceSpecs sources;
  LampSpec lamp;
  lamp.name = "lamp";
  lamp.positions = {{3, 0, 6}};
  lamp.intensity = Curve::constant(10);
  sources.add(lamp);
  PlatformKit kit;
  kit.render(scene, sources,
             collectors("  - {quantity: irradiance, position_m: [0, 0, 2], normal: [0, 0, 1]}\n"
                        "  - {quantity: actinic_flux, position_m: [0, 0, 2]}\n"
                        "  - {quantity: irradiance, position_m: [0, 0, 2], normal: [0, 0, -1]}\n",
                        16));
  const CaptureResult& r = kit.shots.at(0).result;
  EXPECT_NEAR(r.radiance[0], 10 / 25.0 * 0.8, 1e-6);
  EXPECT_NEAR(r.radiance[1], 10 / 25.0, 1e-6);
  EXPECT_EQ(r.radiance[2], 0);
}

// Under a layer that absorbs, direct light is dimmed along its slant way and diffuse light along each of its own.
TEST(Point, MediaDimDirectAndDiffuseLight) {
  const double tau = 0.7;
  PlatformKit kit;
  kit.render(test::slab_scene(test::medium(Curve::constant(tau), Curve::constant(0)), 1), sun_and_sky(0),
             collectors("  - {quantity: irradiance, position_m: [0, 0, 0.0001], normal: [0, 0, 1]}\n", 16384));
  const CaptureResult& r = kit.shots.at(0).result;
  // 2 E3(tau) of a uniform sky (Abramowitz & Stegun 5.1), by quadrature.
  double diffuse = 0;
  for (int i = 0; i < 20000; ++i) {
    const double mu = (i + 0.5) / 20000;
    diffuse += 2 * mu * std::exp(-tau / mu) / 20000;
  }
  const double want = kSun * std::cos(kZenith) * std::exp(-tau / std::cos(kZenith)) + kPi * kSky * diffuse;
  std::printf("under a layer of depth %.1f: %.3f, closed form %.3f\n", tau, r.radiance[0], want);
  EXPECT_NEAR(r.radiance[0], want, 1e-3 * want);
}

TEST(Point, TheTableNamesQuantitiesAndUnits) {
  PlatformKit kit;
  kit.render(plain(), sun_and_sky(0), collectors(kSet, 64));
  ASSERT_EQ(kit.shots.at(0).texts.size(), 1u);
  EXPECT_THAT(kit.shots[0].texts[0].text, testing::HasSubstr("\n1,irradiance,W/(m2 um),b,0.55,1417."));
}

}  // namespace
}  // namespace suite::point_test
