// Throughput that is cut in water, where paths go on in parts and branches: each counts as what it carries. Bug: every
// part counted in full, so that up to twice what was cut was told, while what the surface takes off radiance (the index
// squared) was not given back.
#include <gtest/gtest.h>

#include <cmath>

#include "optics/fresnel.h"
#include "tests/support/media_kit.h"

namespace suite::test::water_cut_test {
namespace {

constexpr double kIndex = 1.33;

// An ocean that absorbs nothing; or, shallow, 1 m over a white bed.
std::shared_ptr<Scene> water(bool shallow, double scattering) {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0), Curve::constant(scattering))};
  scene->media[0].index = Curve::constant(kIndex);
  scene->materials = {material("water", {"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr}),
                      material("bed", lambert(1))};
  scene->materials[0].inside = 0;
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  if (shallow) place(*scene, PrimitiveKind::plane, {0, 0}, 1, translation({0, 0, -1}));
  check_scene(*scene, "water");
  return scene;
}

// The share of the throughput that is cut, in the mean over many problems.
double cut(const std::shared_ptr<Scene>& scene, const PipelineOptions& options, double zenith) {
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.5, 0), 0, Curve::constant(1)});
  sources.add(uniform_sky(0.1, false));
  const Dir view = dir_from_angles(zenith, 0.4);
  auto sensor = std::make_unique<RaySensor>(repeated({view * 2.0, -view, 0}), one_band(), 64);
  const RunStatistics& ran = render(scene, sources, std::move(sensor), options).report.statistics;
  return ran.truncated / static_cast<double>(ran.paths);
}

double passes(double zenith) { return fresnel_dielectric(std::cos(zenith), kIndex).transmittance; }

TEST(WaterCut, AtTheFirstScattering) {
  PipelineOptions options;
  options.max_scatterings = 1;
  for (const double zenith : {0.0, 70 * kDegree})
    EXPECT_NEAR(cut(water(false, 1), options, zenith), passes(zenith), 0.02) << "all that the surface passes";
}

TEST(WaterCut, AtTheBed) {
  PipelineOptions options;
  options.max_nodes = 2;
  for (const double zenith : {0.0, 70 * kDegree})
    EXPECT_NEAR(cut(water(true, 1e-6), options, zenith), passes(zenith), 0.02);
}

// The bed is left as it comes and guided to where the water scatters the sun on; light that is scattered may not come.
TEST(WaterCut, AtTheBedOfScatteringWater) {
  PipelineOptions options;
  options.max_nodes = 2;
  const double share = cut(water(true, 0.3), options, 0);
  EXPECT_LE(share, passes(0) + 0.02);
  EXPECT_GT(share, 0.6 * passes(0));
}

TEST(WaterCut, AtTheSurfaceItself) {
  PipelineOptions options;
  options.max_nodes = 1;
  EXPECT_NEAR(cut(water(false, 1), options, 0), 1, 0.02) << "what it mirrors, too";
}

}  // namespace
}  // namespace suite::test::water_cut_test
