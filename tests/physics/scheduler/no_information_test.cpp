// Problems that end without information are flagged, counted and named, whatever the reason: every ray of the sensor
// has the weight 0, every sample is rejected, one path alone says nothing about its error, one sample alone has brought
// all light (a lens so short that a pixel sees half a sphere with one small bright thing in it). Dark problems that
// were looked at are not flagged, nor are bright ones.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "estimate/error_histogram.h"
#include "sensor/quality.h"
#include "tests/support/lamps_kit.h"

namespace suite::test::no_information_test {
namespace {

const Ray kDown{{0, 0, 3}, {0, 0, -1}, 0};
const Ray kUp{{0, 0, 3}, {0, 0, 1}, 0};

// Weights of its rays, by problem.
class Weighted final : public RaySensor {
 public:
  Weighted(std::vector<Ray> rays, std::vector<double> weights, uint32_t paths)
      : RaySensor(std::move(rays), one_band(), paths), weights_(std::move(weights)) {}
  SensorRay ray(const RayRequest& r) const override { return {rays_[r.problem], weights_[r.problem]}; }

 private:
  std::vector<double> weights_;
};

// Looks anywhere above the horizontal plane.
class HalfSphere final : public RaySensor {
 public:
  explicit HalfSphere(uint32_t problems, uint32_t paths)
      : RaySensor(std::vector<Ray>(problems, kUp), one_band(), paths) {}
  SensorRay ray(const RayRequest& r) const override {
    const double z = r.u[0], s = std::sqrt(1 - z * z), turn = 2 * kPi * r.u[1];
    return {{{0, 0, 3}, {s * std::cos(turn), s * std::sin(turn), z}, 0}, 1};
  }
};

SourceSpecs sky() {
  SourceSpecs s;
  s.add(uniform_sky(1, false));
  return s;
}
std::shared_ptr<Scene> floor_scene() { return scene_of({quad(20, 0, 0)}, {material("floor", lambert(0.5))}); }

TEST(NoInformation, RaysWithoutWeight) {
  const Rendered run =
      render(floor_scene(), sky(),
             std::make_unique<Weighted>(std::vector<Ray>{kDown, kDown, kUp}, std::vector<double>{0, 1, 1}, 64));
  EXPECT_EQ(run.result.quality[0], quality_no_information);
  EXPECT_EQ(run.result.quality[1], 0);
  EXPECT_EQ(run.result.quality[2], 0);
  EXPECT_EQ(run.report.quality[0].counts.with(quality_no_information), 1u);
  EXPECT_EQ(run.report.quality[0].counts.flagged, 1u);
  EXPECT_EQ(text_of(run.report.quality[0].counts), "no_information 1");
}

// Looks down at a black floor under a dark sky: that it is dark is known.
TEST(NoInformation, DarkIsKnown) {
  const auto scene = scene_of({quad(20, 0, 0)}, {material("floor", lambert(0))});
  const Rendered run = render(scene, sky(), std::make_unique<RaySensor>(std::vector<Ray>{kDown}, one_band(), 64));
  EXPECT_EQ(run.result.radiance[0], 0);
  EXPECT_EQ(run.result.quality[0], 0);
}

TEST(NoInformation, EverySampleRejected) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Rendered run =
      render(floor_scene(), sky(),
             std::make_unique<Weighted>(std::vector<Ray>{kDown, kDown}, std::vector<double>{none, 1}, 64));
  EXPECT_EQ(run.result.quality[0], quality_failures | quality_no_information);
  EXPECT_TRUE(std::isinf(run.result.standard_error[0]));
  EXPECT_EQ(run.result.quality[1], 0);
  EXPECT_GT(run.result.radiance[1], 0);
}

TEST(NoInformation, OnePathKnowsNoError) {
  const Rendered run =
      render(floor_scene(), sky(), std::make_unique<RaySensor>(std::vector<Ray>{kDown}, one_band(), 1));
  EXPECT_EQ(run.result.quality[0] & quality_no_information, quality_no_information);
  EXPECT_TRUE(std::isinf(run.report.median_relative_error));
}

// A small lamp somewhere in half a sphere of black.
TEST(NoInformation, OneSampleBroughtAllLight) {
  auto scene = scene_of({quad(0.06, 4, 0)}, {material("lamp", lambert(0))});
  SourceSpecs sources;
  sources.add(std::vector<LampSpec>{glow("lamp", 1, true)});
  // 0.0144 sr of 2 pi: one path in 436.
  const Rendered few = render(scene, sources, std::make_unique<HalfSphere>(64, 64));
  size_t lone = 0, flagged = 0, dark = 0;
  for (size_t i = 0; i < 64; ++i) {
    const double L = few.result.radiance[i];
    const bool flag = few.result.quality[i] & quality_no_information;
    dark += L == 0, flagged += flag;
    const bool alone = L > 0 && few.result.standard_error[i] >= L * (1 - 1e-9);
    lone += alone;
    EXPECT_EQ(flag, alone) << i;
  }
  EXPECT_GT(lone, 3u);
  EXPECT_GT(dark, 20u);
  EXPECT_EQ(few.report.quality[0].counts.with(quality_no_information), flagged);
  // With enough paths all is known.
  const Rendered many = render(scene, sources, std::make_unique<HalfSphere>(8, 1 << 14));
  EXPECT_EQ(many.report.quality[0].counts.with(quality_no_information), 0u);
}

TEST(NoInformation, UnknownErrorsAreTheLargest) {
  ErrorHistogram h;
  h.add(INFINITY), h.add(NAN), h.add(0.01);
  EXPECT_TRUE(std::isinf(h.median()));
  h.add(0.01), h.add(0.01);
  EXPECT_NEAR(h.median(), 0.01, 2e-4);
}

}  // namespace
}  // namespace suite::test::no_information_test
