// Targets for the degree of linear polarisation: what its errors are over repeated seeds, and that stopping early does
// not bias it.
#include <gtest/gtest.h>

#include "math/stats.h"
#include "sensor/degree_target.h"
#include "tests/support/stokes_kit.h"

namespace suite::test::stokes_targets_test {
namespace {

constexpr uint32_t kColumns = 12, kRows = 12;
constexpr size_t kPixels = size_t{kColumns} * kRows;

// A picture of rays with a target.
class Targeted final : public RaySensor, public HasDegreeTarget {
 public:
  // radiance, degree: standard errors that are to be reached, 0 = none; or so many paths.
  Targeted(std::vector<Ray> rays, double radiance, double degree, uint32_t paths)
      : RaySensor(std::move(rays), one_band(), 64),
        own_(RaySensor::tasks().begin(), RaySensor::tasks().end()),
        degree_(degree) {
    Capture& c = own_[0].captures[0];
    c.columns = kColumns, c.rows = kRows, c.neighbours = true;
    c.convergence = {paths ? paths : 32, paths ? paths : 1u << 16, radiance > 0 ? radiance : degree, 0};
    if (!(radiance > 0)) c.band_targets = {0};
  }
  double degree_target(const Capture&) const override { return degree_; }
  std::span<const Task> tasks() const override { return own_; }
  std::span<const std::string> channels() const override {
    static const std::vector<std::string> names{"radiance", "stokes_q", "stokes_u", "depolarised"};
    return names;
  }
  const Polarimetry* polarimetry() const override { return &how_; }

 private:
  Polarimetry how_;
  std::vector<Task> own_;
  double degree_;
};
struct Goal {
  double radiance = 0, degree = 0;
  uint32_t paths = 0;
};

struct World {
  std::shared_ptr<const Scene> scene;
  SourceSpecs sources;
  std::vector<Ray> rays;
};
// All pixels see a place of an even plane alike.
std::vector<Ray> all(const Ray& ray) { return std::vector<Ray>(kPixels, ray); }
Ray towards(double angle, double azimuth) {
  const Dir d = dir_from_angles(kPi - angle, azimuth);
  return {-5 * d, d, 0};
}
World metal() {
  World w{scene_of({quad(100, 0, 0)}, {material("metal", {"ggx",
                                                          {{"roughness", 0.4}},
                                                          {{"n", Curve::constant(1.39)}, {"k", Curve::constant(7.65)}},
                                                          {},
                                                          nullptr})}),
          {},
          all(towards(75 * kDegree, 0.4))};
  w.sources.add(uniform_sky(1, false));
  return w;
}
World air() {
  const ModelSpec rayleigh{"rayleigh", {{"depolarisation", 0.0279}}, {}, {}, nullptr};
  World w{slab_scene(medium(Curve::constant(0), Curve::constant(1), rayleigh), 1), {}, all(towards(40 * kDegree, 1.3))};
  w.sources.add(SunSpec{{dir_from_angles(60 * kDegree, 0.6), 0, Curve::constant(1)}});
  return w;
}
// Facets over a matte body, on matte ground, seen in perspective under a sky.
World ball() {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("ground", lambert(0.3)), material("paint", {"priest_germer",
                                                                           {{"sigma", 0.2}},
                                                                           {{"index", Curve::constant(1.5)},
                                                                            {"absorption", Curve::constant(0)},
                                                                            {"diffuse", Curve::constant(0.1)}},
                                                                           {},
                                                                           nullptr})};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  place(*scene, PrimitiveKind::sphere, {1}, 1, translation({0, 0, 1}));
  check_scene(*scene, "ball");
  World w{std::move(scene), {}, {}};
  w.sources.add(uniform_sky(1, false));
  for (uint32_t row = 0; row < kRows; ++row)
    for (uint32_t column = 0; column < kColumns; ++column) {
      const double x = (column + 0.5) / kColumns - 0.5, z = 0.5 - (row + 0.5) / kRows;
      w.rays.push_back({{0, -6, 2}, normalized(Vec3{0.3 * x, 1, 0.3 * z - 0.15}), 0});
    }
  return w;
}

// Degrees of seeds, and their debiased means.
struct Runs {
  std::vector<std::vector<double>> degree;  // [seed][pixel]
  std::vector<double> mean;                 // [pixel] debiased
  double reported = 0;                      // square of the reported error, mean
  double paths = 0;                         // of a pixel, mean
  JobReport report;
};
Runs run(const World& w, Goal goal, int seeds, uint64_t first = 1) {
  Runs runs;
  runs.mean.resize(kPixels);
  for (int s = 0; s < seeds; ++s) {
    PipelineOptions options;
    options.seed = first + static_cast<uint64_t>(s);
    Rendered r =
        render(w.scene, w.sources, std::make_unique<Targeted>(w.rays, goal.radiance, goal.degree, goal.paths), options);
    std::vector<double> degrees;
    for (size_t i = 0; i < kPixels; ++i) {
      double S[3], error[3], C[6];
      for (size_t c = 0; c < 3; ++c) {
        S[c] = r.result.radiance[i * r.result.channels + c];
        error[c] = r.result.standard_error[i * r.result.channels + c];
      }
      covariances(r.result, i, 0, error, C);
      const LinearPolarisation p = linear_polarisation(S, C);
      degrees.push_back(p.degree);
      runs.reported += p.degree_error * p.degree_error / static_cast<double>(kPixels) / seeds;
      runs.mean[i] += p.debiased / seeds;
      runs.paths += r.result.paths[i] / static_cast<double>(kPixels) / seeds;
    }
    runs.degree.push_back(std::move(degrees));
    runs.report = std::move(r.report);
  }
  return runs;
}
// Sum of squared deviations between seeds over the square of the target, per degree of freedom: 1 at the target.
struct Spread {
  double ratio = 0, degrees = 0;
  // Chance of a sum as large as this one, were the variance `times` the square of the target.
  double chance(double times) const { return chi_square_tail(ratio * degrees / times, degrees); }
};
Spread spread(const Runs& runs, double target) {
  Spread of;
  const double n = static_cast<double>(runs.degree.size());
  for (size_t i = 0; i < kPixels; ++i) {
    double mean = 0;
    for (const auto& d : runs.degree) mean += d[i] / n;
    for (const auto& d : runs.degree) of.ratio += std::pow((d[i] - mean) / target, 2);
  }
  of.degrees = (n - 1) * static_cast<double>(kPixels);
  of.ratio /= of.degrees;
  return of;
}

// Planned from the pilots of 24 neighbours: with three degrees of freedom each the mean of 1 / variance is 72/70 of
// that of the variance, at an edge of the picture 42/40.
constexpr double kPlanned = 42.0 / 40;

// most: variance over the target's square that the plan is known to leave in a scene, times which a run is refused.
void expect_at_target(const char* name, const World& w, double target, double most = 1) {
  constexpr int seeds = 4;
  const Runs runs = run(w, {0, target}, seeds);
  const Spread of = spread(runs, target);
  std::printf(
      "%s: %.0f paths a pixel; variance of the degree over the target's square %.3f (%g degrees of freedom), "
      "as reported %.3f\n",
      name, runs.paths, of.ratio, of.degrees, runs.reported / (target * target));
  EXPECT_GT(of.chance(most * kPlanned), 1e-4) << "once in 10,000 runs";
  EXPECT_GT(runs.paths, 40) << "the pilot did not decide it all";
  EXPECT_NE(runs.report.stopped_by.find("of the degree of linear polarisation"), std::string::npos);
  // A judge that takes half the error stops at a quarter of the paths.
  const Spread half = spread(run(w, {0, 2 * target}, seeds), target);
  std::printf("  of a judge that takes half the error: %.3f\n", half.ratio);
  EXPECT_LT(half.chance(most * kPlanned), 1e-9) << "negative control";
}
// The mean of all pixels beside that of 64 times the paths.
void expect_unbiased(const World& w, double target, uint32_t paths) {
  constexpr int seeds = 6;
  const Runs early = run(w, {0, target}, seeds), long_run = run(w, {0, 0, paths}, 1, 1000);
  double bias = 0;
  for (size_t i = 0; i < kPixels; ++i) bias += (early.mean[i] - long_run.mean[i]) / kPixels;
  const double error = target * std::sqrt((1.0 / seeds + 1.0 / 16) / kPixels);
  std::printf("bias of the mean degree %.2g, one standard error %.2g\n", bias, error);
  EXPECT_LT(std::fabs(bias), 4 * error);
}

TEST(StokesTargets, RoughMetal) { expect_at_target("rough metal", metal(), 0.0015); }
// A few paths bring most of the light of a pilot here, which the degree of a single pilot follows; and pilots of 32
// paths have seen too few of the rarest ones, which make a sixth of the variance.
TEST(StokesTargets, LayerOfAir) { expect_at_target("layer of air", air(), 0.04, 1.2); }
TEST(StokesTargets, PaintedBall) { expect_at_target("painted ball", ball(), 0.02); }

TEST(StokesTargets, StoppingEarlyDoesNotBiasTheDegree) {
  expect_unbiased(metal(), 0.003, 512);
  expect_unbiased(air(), 0.04, 1024);
}

// Both targets hold: the stricter one decides, wherever it is.
TEST(StokesTargets, HoldBesideThoseOfRadiance) {
  const World w = metal();
  const auto paths = [&](double relative, double degree) { return run(w, {relative, degree}, 1).paths; };
  const double degree = paths(0, 0.002), radiance = paths(0.02, 0), both = paths(0.02, 0.002);
  std::printf("paths a pixel: %.0f for the degree, %.0f for radiance, %.0f for both\n", degree, radiance, both);
  EXPECT_GE(both, std::max(degree, radiance));
  EXPECT_LT(both, 1.1 * (degree + radiance));
}

}  // namespace
}  // namespace suite::test::stokes_targets_test
