// Water that scatters forwards over a bed, under a sun that nodes ask for through its surface: continuations guided to
// where that light is scattered from (transport/kernel_guide.h) against paths that meet a wide sun by chance, which
// know nothing of guiding.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/media_kit.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test {
namespace {

constexpr double kIndex = 1.34, kDepth = 4, kWide = 10 * kDegree;

std::shared_ptr<Scene> bay(const ModelSpec& phase, double absorption = 0.05) {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(absorption), Curve::constant(0.25), phase)};
  scene->media[0].index = Curve::constant(kIndex);
  Material surface = material("surface", {"dielectric", {}, {{"index", Curve::constant(kIndex)}}, {}, nullptr});
  surface.inside = 0;
  scene->materials = {material("bed", lambert(0.3)), surface};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -kDepth}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  check_scene(*scene, "bay");
  return scene;
}

Repeated look(const std::shared_ptr<const Scene>& scene, double half_angle, uint32_t paths, bool ask) {
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(40 * kDegree, 0.3), half_angle, Curve::constant(1)});
  const Dir view = dir_from_angles(25 * kDegree, 2);
  PipelineOptions options;
  options.refracted_sources = ask;
  const auto r =
      render(scene, sources, std::make_unique<RaySensor>(repeated({view * 20, -view, 0}), one_band(), paths), options);
  EXPECT_EQ(r.report.statistics.failures, 0u);
  return over_problems(r.result, 0);
}

void expect_alike(const char* what, const ModelSpec& phase) {
  const Repeated chance = look(bay(phase), kWide, 2048, false), guided = look(bay(phase), kWide, 512, true);
  std::printf("%s: by chance %.5g +- %.2f %%, guided %.5g +- %.2f %%\n", what, chance.mean,
              100 * chance.error / chance.mean, guided.mean, 100 * guided.error / guided.mean);
  EXPECT_NEAR(chance.mean, guided.mean, 3.5 * std::hypot(chance.error, guided.error)) << what;  // p = 5e-4
  EXPECT_LT(std::max(chance.error, guided.error), 0.04 * guided.mean) << what;
  // Negative control: water that absorbs half as much again, a fifth of the light, would be seen.
  const Repeated darker = look(bay(phase, 0.075), kWide, 512, true);
  EXPECT_GT(chance.mean - darker.mean, 3.5 * std::hypot(darker.error, chance.error)) << what;
}

// The narrow peak of particles is the hardest under so wide a sun: a node asks for one place on it.
TEST(WaterGuided, FindsWhatChanceFinds) {
  expect_alike("g 0.924", hg(0.924));
  expect_alike("g 0.5", hg(0.5));
  expect_alike("petzold", {"petzold", {}, {}, {}, nullptr});
}

// Spread of a path over the mean under a small sun. Continuations drawn by the bed alone had 4.
TEST(WaterGuided, SmallSunsMakeLittleNoise) {
  const Repeated seen = look(bay(hg(0.924)), 0.27 * kDegree, 1024, true);
  const double spread = seen.error * 8 * std::sqrt(1024.0) / seen.mean;
  std::printf("spread %.2f\n", spread);
  EXPECT_LT(spread, 1.5);
}

}  // namespace
}  // namespace suite::test
