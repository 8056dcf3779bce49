// The halving test of the spectral step.
#include "scheduler/step_check.h"

#include <gtest/gtest.h>

#include "support/radiometry_kit.h"

namespace suite {
namespace {

std::unique_ptr<Sensor> sensor(double step) {
  return std::make_unique<test::RaySensor>(
      std::vector<Ray>(1), std::vector<Band>{Band::gaussian("narrow", 0.7, 0.012), Band::gaussian("wide", 0.85, 0.06)},
      1, step);
}
SourceSpecs sun(const Curve& irradiance) {
  SourceSpecs s;
  s.sun.emplace();
  s.sun->irradiance = irradiance;
  return s;
}
// An absorption line inside the narrow band.
const Curve kLine({0.5, 0.694, 0.696, 0.698, 1.2}, {1000, 1000, 100, 1000, 1000}, Outside::hold);
const auto kScene = test::scene_of({test::quad(1, 0, 0)}, {test::material("grey", test::lambert(0.5))});

TEST(StepCheck, FindsALineThatTheBinsAreTooWideFor) {
  const auto found = coarse_step(*kScene, sun(kLine), *sensor(0.01));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->band, "narrow");
  EXPECT_EQ(found->under, "the sun");
  EXPECT_GT(found->change, kStepLimit);
  ASSERT_GT(found->halvings, 0);
  // What it recommends is right, and half of that many halvings is not.
  EXPECT_FALSE(coarse_step(*kScene, sun(kLine), *sensor(found->bin_um / (1 << found->halvings))));
  EXPECT_TRUE(coarse_step(*kScene, sun(kLine), *sensor(found->bin_um / (1 << (found->halvings - 1)))));
}

TEST(StepCheck, IsSilentWhereAveragesAreEnough) {
  EXPECT_FALSE(coarse_step(*kScene, sun(Curve::constant(1000)), *sensor(0.01)));
  EXPECT_FALSE(coarse_step(*kScene, sun(Curve({0.5, 1.2}, {1000, 1001}, Outside::hold)), *sensor(0.01)));
  EXPECT_FALSE(coarse_step(*kScene, {}, *sensor(0.01)));
}

TEST(StepCheck, LooksAtProductsOfLightAndMaterial) {
  // Both change in opposite senses from bin to bin: only their product tells.
  ModelSpec comb;
  comb.model = "lambert";
  std::vector<double> um, rho, light;
  for (int i = 0; i <= 200; ++i)
    um.push_back(0.6 + 0.002 * i), rho.push_back(i % 2 ? 0.9 : 0.1), light.push_back(i % 2 ? 900 : 100);
  comb.curves["reflectance"] = Curve(um, rho, Outside::hold);
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("comb", comb)});
  const auto found = coarse_step(*scene, sun(Curve(um, light, Outside::hold)), *sensor(0.02));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->under, "the sun on the reflectance of comb");
}

TEST(StepCheck, WarmMaterialsCount) {
  auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("warm", test::lambert(0.1))});
  scene->materials[0].temperature_k = 300;  // at 0.7 um it grows 40-fold over the band
  const auto found = coarse_step(*scene, {}, *sensor(0.03));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->under, "warm warm");
}

}  // namespace
}  // namespace suite
