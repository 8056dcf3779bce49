// Equiangular vertices near lamps (techniques/equiangular.h): single scattering is the integral along the ray, and all
// other light is what it was without them, in combination with boundaries, smooth interfaces, spectra and occluders.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "tests/support/lamps_kit.h"
#include "tests/support/media_kit.h"

namespace suite::test::equiangular_test {
namespace {

// sources seen along one ray by 64 equal problems.
Rendered run_of(const std::shared_ptr<const Scene>& scene, const LampSpec& lamp, const Ray& ray, uint32_t paths,
                bool equiangular, uint32_t most = 0, const std::vector<Band>& bands = one_band()) {
  SourceSpecs sources;
  sources.add(lamp);
  PipelineOptions options;
  options.equiangular = equiangular;
  options.max_scatterings = most;
  auto r = render(scene, sources, std::make_unique<RaySensor>(repeated(ray), bands, paths, 0.02), options);
  EXPECT_EQ(r.report.statistics.failures, 0u);
  return r;
}
Repeated look(const std::shared_ptr<const Scene>& scene, const LampSpec& lamp, const Ray& ray, uint32_t paths,
              bool equiangular, uint32_t most) {
  return over_problems(run_of(scene, lamp, ray, paths, equiangular, most).result, 0);
}

// All space is haze.
std::shared_ptr<Scene> haze(double scattering, double absorption, double g) {
  auto scene = std::make_shared<Scene>();
  scene->groups.push_back({"root", {}});
  scene->media = {medium(Curve::constant(absorption), Curve::constant(scattering), hg(g))};
  scene->ambient = 0;
  check_scene(*scene, "haze");
  return scene;
}

// L = integral of s p(cos) I / d2 exp(-(s + a)(t + d)) dt: one scattering.
TEST(Equiangular, OneScatteringIsTheIntegralAlongTheRay) {
  const Vec3 lamp{0, 1, 12};
  const double s = 0.01, a = 0.005, g = 0.6, intensity = 50;
  double exact = 0;
  constexpr int kSteps = 200000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) * 200 / kSteps;
    const Vec3 to = lamp - Vec3{0, 0, t};
    const double d = length(to), cosine = -to.z / d;  // between back along the ray and towards the lamp
    const double phase = (1 - g * g) / (4 * kPi * std::pow(1 + g * g + 2 * g * cosine, 1.5));
    exact += s * phase * intensity / (d * d) * std::exp(-(s + a) * (t + d)) * 200 / kSteps;
  }
  const Ray ray{{0, 0, 0}, {0, 0, 1}, 0};
  const auto scene = haze(s, a, g);
  const Repeated with = look(scene, point_lamp({lamp}, intensity), ray, 256, true, 1),
                 without = look(scene, point_lamp({lamp}, intensity), ray, 256, false, 1);
  std::printf("exact %.6g, with %.6g +- %.2g, without %.6g +- %.2g: variance / %.0f\n", exact, with.mean, with.error,
              without.mean, without.error, std::pow(without.error / with.error, 2));
  EXPECT_NEAR(with.mean, exact, 4 * with.error);  // p = 6e-5
  EXPECT_LT(with.error, 0.005 * exact);
  EXPECT_LT(with.error, 0.3 * without.error);
  EXPECT_GT(std::fabs(1.02 * with.mean - exact), 4 * with.error);  // negative control: 2 % would be seen
}

struct Combination {
  const char* name;
  std::shared_ptr<Scene> scene;
  LampSpec lamp;
  Ray ray;
  uint32_t paths, paths_without;
};

// A ball of haze in clear space, with the lamp in it.
std::shared_ptr<Scene> ball() {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.01), Curve::constant(0.06), hg(0.7))};
  scene->materials = {boundary(0)};
  place(*scene, PrimitiveKind::sphere, {3}, 0);
  check_scene(*scene, "ball");
  return scene;
}
// A lamp in a pool of turbid water on a bed, seen from above through its smooth surface.
std::shared_ptr<Scene> pool() {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.02), Curve::constant(0.06), hg(0.9))};
  scene->media[0].index = Curve::constant(1.34);
  Material surface = material("surface", {"dielectric", {}, {{"index", Curve::constant(1.34)}}, {}, nullptr});
  surface.inside = 0;
  scene->materials = {material("bed", lambert(0.3)), surface};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -4}));
  place(*scene, PrimitiveKind::plane, {0, 0}, 1);
  check_scene(*scene, "pool");
  return scene;
}
// Haze over ground, with a disk between the ray and the lamp; its extinction falls with the wavelength.
std::shared_ptr<Scene> street() {
  const Curve falling({0.4, 0.7}, {0.02, 0.01}, Outside::hold);
  auto scene = std::make_shared<Scene>();
  scene->media.push_back(medium(Curve::constant(0.005), falling, hg(0.7)));
  scene->ambient = 0;
  scene->materials = {material("ground", lambert(0.4))};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -2}));
  place(*scene, PrimitiveKind::disk, {0.7, 0}, 0, translation({8, 0, 1}));
  check_scene(*scene, "street");
  return scene;
}

TEST(Equiangular, MeansAreThoseWithout) {
  LampSpec spot = point_lamp({{8, 0, 2}, {14, 3, 1}}, 30);
  spot.kind = LampSpec::Kind::spot;
  spot.axis = {0, 0, -1}, spot.inner = 50 * kDegree, spot.outer = 70 * kDegree;
  const Dir down = normalized(Vec3{0.3, 0.1, -1}), along = normalized(Vec3{1, 0.02, 0.01});
  const Combination cases[] = {{"ball", ball(), point_lamp({{0.4, 0.5, 0.2}}, 10), {{-9, 0, 0}, {1, 0, 0}, 0}, 64, 256},
                               {"pool", pool(), point_lamp({{0.2, 0, -2}}, 10), {{-0.6, -0.2, 2}, down, 0}, 64, 512},
                               {"street", street(), spot, {{0, 0, 0}, along, 0}, 32, 256}};
  const std::vector<Band> bands{Band::rectangular("blue", 0.45, 0.002), Band::rectangular("red", 0.65, 0.002)};
  for (const Combination& c : cases) {
    const Rendered runs[] = {run_of(c.scene, c.lamp, c.ray, c.paths, true, 0, bands),
                             run_of(c.scene, c.lamp, c.ray, c.paths_without, false, 0, bands)};
    for (const size_t band : {0u, 1u}) {
      const Repeated with = over_problems(runs[0].result, band), without = over_problems(runs[1].result, band);
      const double error = std::hypot(with.error, without.error);
      std::printf("%s %zu: %.5g +- %.2f %%, without %.5g +- %.2f %%, %+.2f %%\n", c.name, band, with.mean,
                  100 * with.error / with.mean, without.mean, 100 * without.error / without.mean,
                  100 * (without.mean / with.mean - 1));
      EXPECT_NEAR(with.mean, without.mean, 4 * error) << c.name;  // p = 6e-5
    }
  }
}

}  // namespace
}  // namespace suite::test::equiangular_test
