// The paper's estimator (Method::paper) has the mean of the default one, and its parts are what they are said to be:
// one source a node, nothing shared between explicit samples and continuations, independent random numbers.
#include <gtest/gtest.h>

#include <cmath>

#include "light/kinds/lamps.h"
#include "math/stats.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::paper_method_test {
namespace {

std::unique_ptr<RaySensor> looking_down(size_t problems, uint32_t paths) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < problems; ++i) {
    const double x = 0.37 * static_cast<double>(i % 16) - 3, y = 0.41 * static_cast<double>(i / 16) - 3;
    rays.push_back({{x, y, 9}, {0, 0, -1}, 0});
  }
  return std::make_unique<RaySensor>(std::move(rays), one_band(), paths);
}
Rendered run(const std::shared_ptr<Scene>& scene, const SourceSpecs& sources, Method method, size_t problems,
             uint32_t paths, int max_nodes, uint64_t seed) {
  PipelineOptions options;
  options.method = method;
  options.max_nodes = max_nodes;
  options.seed = seed;
  return render(scene, sources, looking_down(problems, paths), options);
}

// A glossy floor between walls that glow and walls that do not.
std::shared_ptr<Scene> room() {
  return scene_of({quad(8, 0, 0), box({-8, -8, 0}, {-6, 8, 3}, 1, true), box({5, -8, 0}, {8, 8, 2}, 2, true)},
                  {material("floor", {"ggx", {{"roughness", 0.4}}, {{"f0", Curve::constant(0.6)}}, {}, nullptr}),
                   material("wall", lambert(0.5)), material("lit", lambert(0.2))});
}
SourceSpecs everything(bool glowing = true) {
  SourceSpecs s;
  s.add(SunSpec{dir_from_angles(0.6, 1), 0.05, Curve::constant(3)});
  s.add(uniform_sky(0.2, false));
  LampSpec points;
  points.positions = {{0, 0, 4}, {2, 1, 5}, {-3, 2, 4}, {1, -3, 6}, {-1, 3, 5}, {3, 3, 4}};
  points.intensity = Curve::constant(2);
  s.add(points);
  LampSpec glow;
  glow.kind = LampSpec::Kind::surface;
  glow.material = "lit";
  glow.radiance = Curve::constant(0.3);
  if (glowing) s.add(glow);
  return s;
}

// p of the difference between the two methods' means over all problems, the second times `factor`.
double p_of_difference(const Rendered& a, const Rendered& b, double factor) {
  double difference = 0, variance = 0;
  for (size_t i = 0; i < a.result.radiance.size(); ++i) {
    difference += a.result.radiance[i] - factor * b.result.radiance[i];
    variance += std::pow(a.result.standard_error[i], 2) + std::pow(factor * b.result.standard_error[i], 2);
  }
  return normal_two_sided(difference / std::sqrt(variance));
}

TEST(PaperMethod, HasTheMeanOfTheDefault) {
  const auto scene = room();
  const Rendered own = run(scene, everything(), Method::standard, 256, 512, 6, 1),
                 paper = run(scene, everything(), Method::paper, 256, 2048, 6, 2);
  EXPECT_GT(p_of_difference(own, paper, 1), 0.001);
  EXPECT_LT(p_of_difference(own, paper, 1.02), 1e-4) << "2 % must be noticed";
}

TEST(PaperMethod, AsksOneSourceANode) {
  const SourceSpecs sources = everything(false);
  const auto scene = scene_of({quad(50, 0, 0)}, {material("floor", lambert(0.5))});
  const auto rays_per_path = [&](Method method) {
    const RunStatistics s = run(scene, sources, method, 64, 64, 1, 1).report.statistics;
    return static_cast<double>(s.trace.rays) / static_cast<double>(s.paths);
  };
  EXPECT_EQ(rays_per_path(Method::paper), 2);                               // the sensor's and one
  EXPECT_EQ(rays_per_path(Method::standard), 2 + LightNature::kMostDraws);  // the sensor's, the sun's, and lamps
}

// A lobe much narrower than the sun's disk: whoever may not count the disk when a continuation meets it draws points on
// the disk that the lobe seldom wants.
TEST(PaperMethod, SharesNothingWithContinuations) {
  SourceSpecs sources;
  sources.add(SunSpec{{{0, 0, 1}, 0.1, Curve::constant(3)}});
  const auto scene =
      scene_of({quad(50, 0, 0)},
               {material("floor", {"ggx", {{"roughness", 0.005}}, {{"f0", Curve::constant(0.6)}}, {}, nullptr})});
  // Problem i looks along one ray, which the sensor is not in the way of.
  const Rendered own = run(scene, sources, Method::standard, 256, 256, 2, 1),
                 paper = run(scene, sources, Method::paper, 256, 4096, 2, 2);
  double own_variance = 0, paper_variance = 0;
  for (size_t i = 0; i < 256; ++i) {
    own_variance += 256 * std::pow(own.result.standard_error[i], 2);
    paper_variance += 4096 * std::pow(paper.result.standard_error[i], 2);
  }
  EXPECT_GT(paper_variance, 100 * own_variance);
  EXPECT_GT(p_of_difference(own, paper, 1), 0.001);
}

// A lobe a few times as wide as the sun's disk: its rare continuations into the disk must not spoil the samples of the
// disk, which hardly vary (under the balance heuristic the relative variance of a path was 7.5e-4).
TEST(SharedSun, RareContinuationsIntoTheDiskBringLittle) {
  SourceSpecs sources;
  sources.add(SunSpec{{{0, 0, 1}, 0.01, Curve::constant(3)}});
  const auto scene =
      scene_of({quad(50, 0, 0)},
               {material("floor", {"ggx", {{"roughness", 0.2}}, {{"f0", Curve::constant(0.6)}}, {}, nullptr})});
  const Rendered own = run(scene, sources, Method::standard, 256, 64, 2, 1),
                 paper = run(scene, sources, Method::paper, 256, 1024, 2, 2);
  double mean = 0, variance = 0;
  for (size_t i = 0; i < 256; ++i) {
    mean += own.result.radiance[i] / 256;
    variance += 64 * std::pow(own.result.standard_error[i], 2) / 256;
  }
  std::printf("relative variance of one path: %.3g\n", variance / (mean * mean));
  EXPECT_GT(p_of_difference(own, paper, 1), 0.001);
  EXPECT_LT(p_of_difference(own, paper, 1.001), 1e-4) << "a thousandth must be noticed";
  EXPECT_LT(variance / (mean * mean), 1e-5);
}

// Uniform sky seen by cosine bounces off a floor, half of it behind a wall of its own: independent numbers have the
// variance of the binomial distribution, low-discrepancy ones far less.
TEST(PaperMethod, DrawsIndependentNumbers) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  const auto scene = scene_of({quad(100, 0, 0), box({-3.5, -90, 0}, {-3.2, 90, 80}, 1, true)},
                              {material("floor", lambert(1)), material("wall", lambert(0))});
  const auto ratio = [&](Method method) {  // observed variance of the problems' errors over the binomial one
    const uint32_t paths = 64;
    const Rendered r = run(scene, sources, method, 256, paths, 2, 3);
    const Rendered truth = run(scene, sources, Method::standard, 256, 8192, 2, 4);
    double square = 0, binomial = 0;
    for (size_t i = 0; i < 256; ++i) {
      const double p = truth.result.radiance[i];
      square += std::pow(r.result.radiance[i] - p, 2);
      binomial += p * (1 - p) / paths;
    }
    return square / binomial;
  };
  EXPECT_NEAR(ratio(Method::paper), 1, 5 * std::sqrt(2.0 / 256));
  EXPECT_LT(ratio(Method::standard), 0.4);
}

TEST(PaperMethod, RefusesMoreLampsThanANodeHolds) {
  PipelineOptions options;
  options.lamp_draws = LightNature::kMostDraws + 1;
  EXPECT_THROW(render(room(), everything(), looking_down(4, 4), options), Error);
}

}  // namespace
}  // namespace suite::test::paper_method_test
