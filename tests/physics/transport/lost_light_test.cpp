// Light behind smooth refracting surfaces that paths do not find: it must be said, with its size, and nothing else may
// be called so. Suns are not asked for through the surfaces here (refracted_flat_test.cpp does): their light stands for
// what is never asked for, behind three interfaces or by lamps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "optics/fresnel.h"
#include "tests/support/even_within.h"
#include "tests/support/lamps_kit.h"
#include "tests/support/media_kit.h"

namespace suite::test::lost_light_test {
namespace {

constexpr double kIndex = 1.33, kReflectance = 0.3, kDepth = 2;
const double kSunZenith = 30 * kDegree, kViewZenith = 20 * kDegree;

ModelSpec smooth(double index) { return {"dielectric", {}, {{"index", Curve::constant(index)}}, {}, nullptr}; }

// A Lambert bed under clear water of endless extent.
std::shared_ptr<Scene> water_bed(ModelSpec surface) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("bed", lambert(kReflectance)), material("water", std::move(surface))};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  place(*scene, PrimitiveKind::plane, {0, 0}, 1, translation({0, 0, kDepth}));
  check_scene(*scene, "water bed");
  return scene;
}

SourceSpecs sun(double half_angle_deg, double zenith = kSunZenith) {
  SourceSpecs s;
  s.add(SunSpec{dir_from_angles(zenith, 0), half_angle_deg * kDegree, Curve::constant(1)});
  return s;
}

std::unique_ptr<RaySensor> look(uint32_t paths, std::vector<Band> bands = one_band()) {
  const Dir view = dir_from_angles(kViewZenith, 0.4);
  return std::make_unique<RaySensor>(std::vector<Ray>{{view * 10.0, -view, 0}}, std::move(bands), paths);
}

PipelineOptions unasked() {
  PipelineOptions options;
  options.refracted_sources = false;
  return options;
}

bool unresolved(const Rendered& r) { return r.result.quality[0] & quality_unresolved; }

// L = (rho / pi) E cos(z) T(z) T(v) / (n^2 (1 - rho r)) with r the reflectance of the surface for diffuse light from
// below: flux through the flat surface is conserved, the bed and the surface reflect it to and fro.
double closed_form() {
  const double inside = reflected_within(kIndex);
  const double down = fresnel_dielectric(std::cos(kSunZenith), kIndex).transmittance,
               up = fresnel_dielectric(std::cos(kViewZenith), kIndex).transmittance;
  return kReflectance / kPi * std::cos(kSunZenith) * down * up / (kIndex * kIndex * (1 - kReflectance * inside));
}

// Bug: this light was 0 with a standard error of 0 and no flag.
TEST(WaterBed, CollimatedSunIsMissedAndSaid) {
  const double truth = closed_form();
  EXPECT_NEAR(truth, 0.0522, 5e-5);  // PHYSICS.md, section 10
  const auto run = render(water_bed(smooth(kIndex)), sun(0), look(4096), unasked());
  EXPECT_EQ(run.result.radiance[0], 0) << "nothing asks for this light";
  EXPECT_NEAR(run.result.standard_error[0], truth, 0.03 * truth)
      << "flat interfaces: the estimate is exact in the mean";
  EXPECT_TRUE(unresolved(run));
  const Shortfall& told = run.report.shortfalls.at(0).shortfall;
  EXPECT_EQ(told.unresolved.problems, 1u);
  EXPECT_NEAR(told.unresolved.mean(), 1, 1e-12) << "all of its light";
  EXPECT_THAT(
      lines_of(diagnose_shortfall("s", told)),
      testing::ElementsAre(testing::AllOf(testing::HasSubstr("1 of 1 problems are not resolved"),
                                          testing::HasSubstr("up to all of it"), testing::HasSubstr("[DR201]"))));
}

TEST(WaterBed, SmallDiskIsMissedWideDiskIsMet) {
  const double truth = closed_form();
  // 0.27 degrees: 65 536 paths expect 1.4 meetings along unbent lines.
  const auto small = render(water_bed(smooth(kIndex)), sun(0.27), look(65536), unasked());
  EXPECT_TRUE(unresolved(small));
  EXPECT_GT(small.result.standard_error[0], 0.5 * truth);
  EXPECT_LT(std::fabs(small.result.radiance[0] - truth), 2 * small.result.standard_error[0]);
  // 5 degrees: 27 of 4096.
  const auto wide = render(water_bed(smooth(kIndex)), sun(5), look(4096), unasked());
  EXPECT_FALSE(unresolved(wide));
  const auto few = render(water_bed(smooth(kIndex)), sun(5), look(1024), unasked());
  EXPECT_TRUE(unresolved(few)) << "7 meetings";
  const auto many = render(water_bed(smooth(kIndex)), sun(5), look(65536), unasked());
  EXPECT_FALSE(unresolved(many));
  EXPECT_NEAR(many.result.radiance[0], truth, 5 * many.result.standard_error[0]);  // 8 scrambles: p = 0.002
  EXPECT_LT(many.result.standard_error[0], 0.2 * truth);
}

// Straight lines that meet the surface from below beyond the critical angle: real light has a way in.
TEST(WaterBed, LowSun) {
  const auto run = render(water_bed(smooth(kIndex)), sun(0, 70 * kDegree), look(1024), unasked());
  const double expected = closed_form() * std::cos(70 * kDegree) / std::cos(kSunZenith) *
                          fresnel_dielectric(std::cos(70 * kDegree), kIndex).transmittance /
                          fresnel_dielectric(std::cos(kSunZenith), kIndex).transmittance;
  EXPECT_TRUE(unresolved(run));
  EXPECT_NEAR(run.result.standard_error[0], expected, 0.1 * expected);
}

TEST(WaterBed, PointLampsAboveAreMissedBelowAreNot) {
  const auto lamp_at = [](double height) {
    SourceSpecs s;
    s.add(point_lamp({{0.5, 0, height}}, 1));
    return s;
  };
  const auto above = render(water_bed(smooth(kIndex)), lamp_at(kDepth + 1), look(256), unasked());
  EXPECT_TRUE(unresolved(above));
  EXPECT_EQ(above.result.radiance[0], 0);
  EXPECT_GT(above.result.standard_error[0], 0);
  const auto below = render(water_bed(smooth(kIndex)), lamp_at(kDepth - 1), look(256), unasked());
  EXPECT_FALSE(unresolved(below));
  EXPECT_GT(below.result.radiance[0], 0);
}

// What an opaque thing shadows is not missing, however much water lies before it. Bug: it was where the water was a
// medium, behind whose surface nothing was looked for; that flagged a third of a pool's pixels.
class OpaqueBlocker : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(InWater, OpaqueBlocker, testing::Bool());
TEST_P(OpaqueBlocker, BehindTheWater) {
  const auto scene = water_bed(smooth(kIndex));
  if (GetParam()) {
    scene->media = {medium(Curve::constant(0.1), Curve::constant(0))};
    scene->media[0].index = Curve::constant(kIndex);
    scene->materials[1].inside = 0;
  }
  scene->materials.push_back(material("black", lambert(0)));  // or its lower side would be lit from beside its shadow
  scene->meshes.push_back(quad(400, 0, 2));
  scene->groups[0].placements.push_back({translation({400 * std::tan(kSunZenith), 0, 400}), TargetKind::mesh, 0});
  check_scene(*scene, "blocked");
  const auto run = render(scene, sun(0), look(1024), unasked());
  EXPECT_FALSE(unresolved(run));
  EXPECT_EQ(run.result.standard_error[0], 0);
}

TEST(WaterBed, RoughWaterIsFound) {
  ModelSpec rough = smooth(kIndex);
  rough.model = "ggx_dielectric";
  rough.numbers["roughness"] = 0.2;
  const auto run = render(water_bed(rough), sun(0), look(4096), unasked());
  EXPECT_FALSE(unresolved(run));
  EXPECT_GT(run.result.radiance[0], 0.5 * closed_form());
}

TEST(WaterBed, DispersionAndBands) {
  ModelSpec glass = smooth(kIndex);
  glass.curves["index"] = Curve({0.4, 0.7}, {1.36, 1.32}, Outside::hold);
  const std::vector<Band> bands{Band::rectangular("a", 0.45, 0.01), Band::rectangular("b", 0.65, 0.01)};
  const auto run = render(water_bed(glass), sun(0), look(4096, bands), unasked());
  EXPECT_TRUE(unresolved(run));
  for (const double error : run.result.standard_error) EXPECT_NEAR(error, closed_form(), 0.15 * closed_form());
}

// The estimate takes the media on its way along: 1 / m of absorption in the second band, over the straight way of the
// light and the bent one of the view.
TEST(WaterBed, AbsorbingWater) {
  const auto scene = water_bed(smooth(kIndex));
  scene->media = {medium(Curve({0.54, 0.56}, {0, 1}, Outside::hold), Curve::constant(0))};
  scene->media[0].index = Curve::constant(kIndex);
  scene->materials[1].inside = 0;
  check_scene(*scene, "absorbing");
  const std::vector<Band> bands{Band::rectangular("clear", 0.5, 0.01), Band::rectangular("dark", 0.6, 0.01)};
  const auto run = render(scene, sun(0), look(4096, bands), unasked());
  EXPECT_TRUE(unresolved(run));
  EXPECT_NEAR(run.result.standard_error[0], closed_form(), 0.03 * closed_form());
  const double up = kDepth / std::sqrt(1 - std::pow(std::sin(kViewZenith) / kIndex, 2)),
               down = kDepth / std::cos(kSunZenith);
  const double once = closed_form() * (1 - kReflectance * 0.47) * std::exp(-up - down);
  EXPECT_GT(run.result.standard_error[1], 0.95 * once);
  EXPECT_LT(run.result.standard_error[1], 1.1 * once) << "light that comes back from the surface is dark";
}

// Murky water without a bed: the nodes are scatterings in the medium.
TEST(WaterBed, ScatteringWater) {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.2), Curve::constant(1))};
  scene->materials = {material("water", smooth(kIndex))};
  scene->materials[0].inside = 0;
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  check_scene(*scene, "murky");
  const auto run = render(scene, sun(0), look(1024), unasked());
  EXPECT_TRUE(unresolved(run));
  EXPECT_EQ(run.result.radiance[0], 0);
  EXPECT_GT(run.result.standard_error[0], 1e-3);
  scene->materials[0].surface = {};  // index-matched: the same light arrives
  check_scene(*scene, "murky air");
  const auto found = render(scene, sun(0), look(1024), unasked());
  EXPECT_FALSE(unresolved(found));
  EXPECT_GT(found.result.radiance[0], 10 * found.result.standard_error[0]);
}

// One path shows what many suns would: each of them is lost alike.
class Suns final : public RaySensor {
 public:
  using RaySensor::RaySensor;
  std::span<const Task> tasks() const override {
    if (tasks_.empty()) {
      tasks_.assign(RaySensor::tasks().begin(), RaySensor::tasks().end());
      Capture& c = tasks_[0].captures[0];
      c.bin_by = Capture::BinBy::sun;
      c.suns = {dir_from_angles(kSunZenith, 0), dir_from_angles(0.1, 2)};
      c.bins = 2;
    }
    return tasks_;
  }

 private:
  mutable std::vector<Task> tasks_;
};

TEST(WaterBed, ManySuns) {
  const Dir view = dir_from_angles(kViewZenith, 0.4);
  const auto run =
      render(water_bed(smooth(kIndex)), {},
             std::make_unique<Suns>(std::vector<Ray>{{view * 10.0, -view, 0}}, one_band(), 4096), unasked());
  EXPECT_TRUE(unresolved(run));
  ASSERT_EQ(run.result.standard_error.size(), 2u);
  EXPECT_NEAR(run.result.standard_error[0], closed_form(), 0.03 * closed_form());
  EXPECT_GT(run.result.standard_error[1], run.result.standard_error[0]);
}

// Glass that stands where no light of the picture passes: looking for lost light changes neither radiance nor error.
TEST(LostLight, LookingForItChangesNothingElse) {
  const auto scene = [](bool glass) {
    auto s = scene_of({quad(3, 0, 0), box({-1, -1, 0}, {0.5, 0.5, 1}, 0, true), quad(0.5, -50, 1)},
                      {material("grey", lambert(0.5)), material("glass", glass ? smooth(1.5) : lambert(0.2))});
    s->materials[0].temperature_k = 300;  // no matte kernel
    return s;
  };
  std::vector<Ray> rays;
  for (int i = 0; i < 32; ++i) rays.push_back({{0, 0, 4}, normalized(Vec3{0.06 * (i - 16), 0.1, -1}), 0});
  const auto with = render(scene(true), sun(0.27), std::make_unique<RaySensor>(rays, one_band(), 64)),
             without = render(scene(false), sun(0.27), std::make_unique<RaySensor>(rays, one_band(), 64));
  EXPECT_EQ(with.result.radiance, without.result.radiance);
  EXPECT_EQ(with.result.standard_error, without.result.standard_error);
  EXPECT_EQ(with.result.quality, without.result.quality);
}

TEST(LostLight, IsToldBeforeThePathsAreRun) {
  const auto warnings = [](const SourceSpecs& sources, ModelSpec surface, uint32_t paths, bool asked = false) {
    std::vector<std::string> said;
    JobOptions job;
    job.progress = false;
    job.pipeline.refracted_sources = asked;
    job.diagnose = [&](const Diagnostic& d) {
      if (d.code >= Dr::unresolved_refracted && d.code <= Dr::caustics_not_found) said.push_back(line_of(d));
    };
    std::vector<std::unique_ptr<Sensor>> sensors;
    sensors.push_back(look(paths));
    run_job(water_bed(std::move(surface)), sources, sensors, job);
    return said;
  };
  using testing::AllOf, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;
  EXPECT_THAT(warnings(sun(0), smooth(kIndex), 4),
              ElementsAre(AllOf(HasSubstr("the sun (collimated) is not found behind"), HasSubstr("'water'"),
                                HasSubstr("[DR205]")),
                          AllOf(HasSubstr("caustics: light of"), HasSubstr("'water'"))));
  EXPECT_THAT(warnings(sun(0), smooth(kIndex), 4, true), ElementsAre(HasSubstr("caustics: light of")));
  EXPECT_THAT(warnings(sun(0.27), smooth(kIndex), 4), ElementsAre(HasSubstr("one path in"), HasSubstr("one path in")));
  EXPECT_THAT(warnings(sun(0), {"mirror", {}, {{"reflectance", Curve::constant(0.9)}}, {}, nullptr}, 4),
              ElementsAre(HasSubstr("caustics: light of")));
  // Photons look for a disk in mirrors, never for what no path can meet.
  SourceSpecs both = sun(0);
  both.add(SunSpec{dir_from_angles(0.2, 0), 0.27 * kDegree, Curve::constant(1)});
  const ModelSpec mirror{"mirror", {}, {{"reflectance", Curve::constant(0.9)}}, {}, nullptr};
  EXPECT_THAT(warnings(sun(0.27), mirror, 4),
              ElementsAre(AllOf(HasSubstr("found by photon-guided sampling"), HasSubstr("[DR206]"))));
  EXPECT_THAT(warnings(both, mirror, 4),
              ElementsAre(HasSubstr("found by photon-guided sampling"),
                          AllOf(HasSubstr("is not found and not estimated"), HasSubstr("[DR207]"))));
  EXPECT_THAT(warnings(sun(5), smooth(kIndex), 4096), IsEmpty());
  EXPECT_THAT(warnings(sun(0), lambert(0.1), 4), IsEmpty());
}

}  // namespace
}  // namespace suite::test::lost_light_test
