// The kernel for matte scenes against the general one: the same sample points must give the same pictures, truth and
// counts, to the rounding of the order of multiplications; and it must not be taken for scenes that it does not serve.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "light/kinds/moon.h"
#include "math/sampling.h"
#include "support/lamps_kit.h"
#include "support/radiometry_kit.h"

namespace suite::matte_kernel_test {
namespace {

const Curve kGreen({0.3, 0.5, 0.55, 0.7, 1.0}, {0.05, 0.1, 0.2, 0.05, 0.6}, Outside::hold);

// A court of coloured walls with a dome in it, whose shading normals are smooth.
std::shared_ptr<Scene> court(const std::function<void(Scene&)>& change = {}) {
  ModelSpec green;
  green.model = "lambert";
  green.curves["reflectance"] = kGreen;
  Mesh walls = test::box({-3, -3, -2}, {3, 3, 2}, 0, false);
  walls.indices = std::vector<uint32_t>(
      walls.indices.begin(), walls.indices.begin() + walls.indices.size() / 2);  // half of the box is open to the sky
  walls.parts[0].triangle_count = static_cast<uint32_t>(walls.triangle_count());
  Mesh hill = test::dome(2);
  hill.parts[0].material = 1;
  const auto scene = test::scene_of({std::move(walls), std::move(hill), test::quad(5, -2.5, 2)},
                                    {test::material("wall", test::lambert(0.8)), test::material("green", green),
                                     test::material("ground", test::lambert(0.3))});
  if (change) change(*scene);
  return scene;
}

SourceSpecs sources(double half_angle, bool full_sphere) {
  SourceSpecs s;
  s.add(SunSpec{dir_from_angles(0.6, 1), half_angle, Curve({0.3, 1.0}, {2000, 900}, Outside::hold)});
  s.add(test::uniform_sky(30, full_sphere));
  return s;
}

// 64 rays from above and from inside; every eighth counts half.
class Rays final : public test::RaySensor {
 public:
  using RaySensor::RaySensor;
  SensorRay ray(const RayRequest& request) const override {
    return {rays_[request.problem], request.problem % 8 ? 1.0 : 0.5};
  }
  std::span<const std::string> truth() const override { return names; }
  std::vector<std::string> names{"material", "instance",       "range",      "location", "paths",
                                 "hits",     "time",           "normal",     "nodes",    "incidence",
                                 "tag",      "sun_visibility", "reflectance"};
};

std::unique_ptr<Rays> rays(std::vector<Band> bands, uint32_t paths) {
  std::vector<Ray> list;
  Pcg32 random(5);
  for (int i = 0; i < 64; ++i) {
    const Vec3 from{random.uniform() - 0.5, random.uniform() - 0.5, i % 2 ? 20.0 : 1.5};
    const Vec3 to{4 * random.uniform() - 2, 4 * random.uniform() - 2, -2};
    list.push_back({from, normalized(to - from), 0});
  }
  return std::make_unique<Rays>(std::move(list), std::move(bands), paths);
}

std::vector<Band> side_by_side(size_t n) {
  std::vector<Band> bands;
  for (size_t b = 0; b < n; ++b)
    bands.push_back(Band::rectangular("b" + std::to_string(b), 0.5 + 0.01 * static_cast<double>(b), 0.01));
  return bands;
}
std::vector<Band> overlapping(size_t n) {
  std::vector<Band> bands;
  for (size_t b = 0; b < n; ++b)
    bands.push_back(Band::gaussian("b" + std::to_string(b), 0.5 + 0.01 * static_cast<double>(b), 0.02));
  return bands;
}

test::Rendered run(const std::shared_ptr<Scene>& scene, const SourceSpecs& from, const std::vector<Band>& bands,
                   bool specialise, uint32_t paths = 40, int max_nodes = 6) {
  PipelineOptions options;
  options.specialise = specialise;
  options.max_nodes = max_nodes;
  return test::render(scene, from, rays(bands, paths), options);
}

// Largest difference of two arrays, relative to the largest value of a third.
double difference(const std::vector<double>& a, const std::vector<double>& b, const std::vector<double>& scale) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0, most = 0;
  for (const double s : scale)
    if (!std::isnan(s)) most = std::max(most, std::fabs(s));
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(std::isnan(a[i]), std::isnan(b[i])) << i;
    if (std::isnan(a[i])) continue;
    worst = std::max(worst, std::fabs(a[i] - b[i]));
  }
  return worst / most;
}
double difference(const std::vector<double>& a, const std::vector<double>& b) { return difference(a, b, a); }

void expect_same(const std::shared_ptr<Scene>& scene, const SourceSpecs& from, const std::vector<Band>& bands,
                 uint32_t paths = 40, int max_nodes = 6) {
  const test::Rendered fast = run(scene, from, bands, true, paths, max_nodes),
                       slow = run(scene, from, bands, false, paths, max_nodes);
  const std::string air = from.atmosphere ? " in air" : "";
  ASSERT_EQ(fast.report.log[0].kernel, "matte" + air);
  ASSERT_EQ(slow.report.log[0].kernel, "general" + air);
  EXPECT_LT(difference(slow.result.radiance, fast.result.radiance), 1e-6);
  // Standard errors inherit the rounding of the radiance, and may be much smaller than it.
  EXPECT_LT(difference(slow.result.standard_error, fast.result.standard_error, slow.result.radiance), 1e-6);
  EXPECT_LT(difference(slow.result.truth, fast.result.truth), 1e-12);
  EXPECT_EQ(slow.result.quality, fast.result.quality);
  const RunStatistics &a = slow.report.statistics, &b = fast.report.statistics;
  EXPECT_EQ(a.paths, b.paths);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.trace.rays, b.trace.rays);
  EXPECT_EQ(a.failures, b.failures);
  EXPECT_NEAR(a.truncated, b.truncated, 1e-6 * (a.truncated + 1));
}

TEST(MatteKernel, GivesThePictureOfTheGeneralOne) {
  for (const double half_angle : {0.0, 0.00465, 0.3})
    for (const bool full_sphere : {false, true}) {
      SCOPED_TRACE(testing::Message() << half_angle << (full_sphere ? ", full" : ""));
      expect_same(court(), sources(half_angle, full_sphere), side_by_side(1));
      expect_same(court(), sources(half_angle, full_sphere), side_by_side(1), 40, 3);
    }
  EXPECT_GT(run(court(), sources(0, true), side_by_side(1), true, 40, 3).report.statistics.truncated, 0)
      << "nothing was tested of paths that are cut";
}

TEST(MatteKernel, ForAnyNumberOfBands) {
  for (const size_t n : {1u, 7u, 8u, 9u, 40u}) {
    SCOPED_TRACE(n);
    expect_same(court(), sources(0.1, true), side_by_side(n));
    expect_same(court(), sources(0.1, true), overlapping(n));
  }
}

TEST(MatteKernel, WithEitherSourceAloneAndFewNodesOrSamples) {
  SourceSpecs sun = sources(0.02, false), sky = sun;
  sun.lights.pop_back(), sky.lights.erase(sky.lights.begin());
  expect_same(court(), sun, side_by_side(3));
  expect_same(court(), sky, side_by_side(3));
  expect_same(court(), sources(0.02, true), side_by_side(3), 3, 1);
  expect_same(court(), sources(0.02, true), side_by_side(3), 600, 2);
}

TEST(MatteKernel, UnderAnyLightsAndInAir) {
  SourceSpecs lamp = sources(0.02, false), moon = lamp, table = lamp, air = lamp;
  lamp.add(test::point_lamp({{0, 0, 3}, {0.5, 0.2, 2}}, 1));
  expect_same(court(), lamp, side_by_side(3));
  table.lights.pop_back();
  table.add(SkySpec{Curve::constant(30), {1, 2, 1, 2}, 2, 2, false});
  expect_same(court(), table, side_by_side(3));
  FarDisk disk = *moon.sun()->disk();
  disk.direction = {0.6, 0, 0.8};
  moon.add(MoonSpec{{disk}, false, false, false, {}});
  expect_same(court(), moon, side_by_side(3));
  air.atmosphere.emplace();
  expect_same(court(), air, side_by_side(3));
}

// Negative control: a scene with one reflectance changed by a hundred-thousandth must fail the comparison.
TEST(MatteKernel, TheComparisonSeesAHundredThousandth) {
  const auto changed =
      court([](Scene& s) { s.materials[0].surface.curves["reflectance"] = Curve::constant(0.8 * 1.00001); });
  const test::Rendered a = run(court(), sources(0, true), side_by_side(1), false),
                       b = run(changed, sources(0, true), side_by_side(1), true);
  EXPECT_GT(difference(a.result.radiance, b.result.radiance), 1e-6);
}

TEST(MatteKernel, IsNotTakenWhereItDoesNotServe) {
  const auto kernel = [](const std::shared_ptr<Scene>& scene, const SourceSpecs& from, PipelineOptions options = {}) {
    return test::render(scene, from, rays(side_by_side(1), 4), options).report.log[0].kernel;
  };
  const SourceSpecs plain = sources(0.01, false);
  EXPECT_EQ(kernel(court(), plain), "matte");
  EXPECT_EQ(
      kernel(court([](Scene& s) { s.materials[1].surface.curves["transmittance"] = Curve::constant(0.1); }), plain),
      "general");
  EXPECT_EQ(kernel(court([](Scene& s) { s.materials[1].temperature_k = 2000; }), plain), "general");
  SourceSpecs lamp = plain, moon = plain, table = plain;
  // Any lights do, and air.
  lamp.add(test::point_lamp({{0, 0, 3}}, 1));
  EXPECT_EQ(kernel(court(), lamp), "matte");
  table.lights.pop_back();
  table.add(SkySpec{Curve::constant(30), {1, 2, 1, 2}, 2, 2, false});
  EXPECT_EQ(kernel(court(), table), "matte");
  moon.add(MoonSpec{{*plain.sun()->disk()}, false, false, false, {}});
  EXPECT_EQ(kernel(court(), moon), "matte");
  SourceSpecs air = plain;
  air.atmosphere.emplace();
  EXPECT_EQ(kernel(court(), air), "matte in air");
  PipelineOptions paper, change, chance;
  paper.method = Method::paper, change.stop = StopRule::change, chance.explicit_sources = false;
  EXPECT_EQ(kernel(court(), plain, paper), "general");
  for (const PipelineOptions& o : {change, chance}) EXPECT_EQ(kernel(court(), plain, o), "matte");
}

}  // namespace
}  // namespace suite::matte_kernel_test
