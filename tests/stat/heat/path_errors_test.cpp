// Standard errors by paths against runs with other seeds, the bias of few paths, and the balance of the whole scene, in
// a street of two houses on a summer day.
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "heat/target_paths.h"
#include "support/heated_scene_kit.h"
#include "support/slab_kit.h"

namespace suite::path_errors_test {
namespace {

using namespace test;

constexpr uint64_t kRuns = 32;

// A box without its floor, which would see nothing but the ground that it lies on.
Mesh house(Vec3 low, Vec3 high, uint32_t material) {
  Mesh m = box(low, high, material, true);
  m.indices = std::vector<uint32_t>(m.indices.begin() + 6, m.indices.end());
  m.parts.front().triangle_count = static_cast<uint32_t>(m.triangle_count());
  return m;
}

HeatKit street() {
  HeatedScene s;
  TemperatureSpec asphalt = heat({}, {{"convection", "mcadams"}}), brick = asphalt;
  asphalt.layers = {uniform(0.1, 2200, 900, 1.2), uniform(0.6, 1800, 900, 1)};
  brick.layers = {uniform(0.25, 1700, 850, 0.8)};
  brick.numbers = {{"back_k", 294}, {"back_film_w_m2_k", 8}};
  brick.texts["back"] = "air";
  const uint32_t ground = s.heated(0.9, asphalt), wall = s.heated(0.6, brick),
                 leaf = s.heated(lambert(0.3, 0.1), heat({}, {{"back", "open"}, {"convection", "mcadams"}}));
  s.mesh(quad(8, 0, ground));
  s.mesh(house({-6, -7, 0}, {-3, 7, 5}, wall));
  s.mesh(house({3, -7, 0}, {6, 7, 4}, wall));
  s.plane(1.5, 1.5, leaf, shifted({0, 3, 3}));
  return HeatKit(std::move(s), 120);
}

HeatSpec spec_of(uint32_t paths, uint64_t seed) {
  HeatSpec spec;
  spec.span = {0, 86400};
  spec.step = 1800;  // two in each part of the span
  spec.paths = paths, spec.seed = seed, spec.tolerance = 1e-3;
  return spec;
}

// Means over the parts of the span, K: [face][part].
std::vector<double> by_part(const HeatResult& r) {
  const size_t faces = r.emissivity.size();
  std::vector<double> sum(faces * kHeatParts, 0), count(sum);
  for (size_t f = 0; f < faces; ++f)
    for (size_t k = 0; k < r.moments; ++k) {
      const size_t p = f * kHeatParts + std::min<size_t>(kHeatParts - 1, k * kHeatParts / r.moments);
      sum[p] += double{r.kelvin[f * r.moments + k]}, count[p] += 1;
    }
  for (size_t i = 0; i < sum.size(); ++i) sum[i] /= count[i];
  return sum;
}

TEST(PathErrors, CoverWhatOtherSeedsFind) {
  const HeatKit kit = street();
  const Weather weather = summer_weather();
  const WeatherLoads loads = summer_loads(weather, spec_of(64, 1));
  std::vector<std::vector<double>> kelvin;
  std::vector<std::vector<float>> errors;
  for (uint64_t seed = 1; seed <= kRuns; ++seed) {
    const HeatResult r = kit.solve(loads, spec_of(64, seed));
    kelvin.push_back(by_part(r)), errors.push_back(r.path_error);
  }
  const size_t n = kelvin[0].size();
  std::vector<double> mean(n, 0);
  for (const auto& run : kelvin)
    for (size_t i = 0; i < n; ++i) mean[i] += run[i] / kRuns;
  // Student's t of 8 degrees of freedom for 95 %; the mean that stands for the truth scatters with 1/32 of the variance
  // and takes part of it out of the difference.
  const double t = 2.3060 * std::sqrt(1 - 1.0 / kRuns);
  size_t covered = 0, halved = 0;
  double found = 0, told = 0;
  for (size_t r = 0; r < kRuns; ++r)
    for (size_t i = 0; i < n; ++i) {
      const double off = std::fabs(kelvin[r][i] - mean[i]), error = double{errors[r][i]};
      covered += off <= t * error, halved += off <= t * error / 2;
      found += off * off / (kRuns - 1), told += error * error / kRuns;
    }
  const double all = static_cast<double>(n * kRuns), share = 100 * static_cast<double>(covered) / all,
               control = 100 * static_cast<double>(halved) / all;
  found = std::sqrt(found / static_cast<double>(n)), told = std::sqrt(told / static_cast<double>(n));
  std::printf(
      "path errors: %zu faces, 95 %% intervals cover %.2f %% (of halved errors %.1f %%); %.4f K told, %.4f K found\n",
      kit.faces->size(), share, control, told, found);
  EXPECT_GT(share, 93);
  EXPECT_LT(share, 97);
  EXPECT_LT(control, 93);

  // Bias of 64 paths: against 4096, whose own error is told; of the element means, over all elements and each.
  const HeatResult many = kit.solve(loads, spec_of(4096, 77));
  const std::vector<double> truth = by_part(many);
  double bias = 0, worst = 0, weight = 0;
  size_t beyond = 0;
  for (size_t i = 0; i < n; ++i) {
    const double off = mean[i] - truth[i], area = (*kit.elements)[kit.faces->element(i / kHeatParts)].area;
    double variance = std::pow(double{many.path_error[i]}, 2);
    for (size_t r = 0; r < kRuns; ++r) variance += std::pow((kelvin[r][i] - mean[i]) / kRuns, 2);
    bias += area * off, weight += area;
    worst = std::fmax(worst, std::fabs(off));
    beyond += std::fabs(off) > 0.02 + 3 * std::sqrt(variance);
  }
  std::printf(
      "bias of 64 paths: %.4f K over all, the worst part of an element %.3f K, %zu of %zu beyond 0.02 K and 3 "
      "standard errors\n",
      bias / weight, worst, beyond, n);
  EXPECT_LT(std::fabs(bias / weight), 0.02);
  EXPECT_LE(static_cast<double>(beyond), 0.01 * static_cast<double>(n));
}

// Paths chosen from a pilot: the error told by the run itself is what was asked for, within what the pilot knows (the
// errors of a face are of 7 degrees of freedom, those of all together of many).
TEST(PathErrors, PathsForATarget) {
  const HeatKit kit = street();
  const Weather weather = summer_weather();
  const WeatherLoads loads = summer_loads(weather, spec_of(64, 1));
  uint32_t before = 0;
  for (const double target : {0.2, 0.1}) {
    const TargetPaths t = paths_for(target, *kit.tracer, *kit.elements, *kit.faces, kit.optics, loads, spec_of(64, 1));
    const double told = mean_path_error(kit.solve(loads, spec_of(t.paths, 1)), *kit.elements, *kit.faces);
    std::printf("target %.2g K: %.3f K with %u paths, so %u, which tell %.4f K\n", target, t.pilot_error, t.pilot_paths,
                t.paths, told);
    EXPECT_TRUE(t.enough);
    EXPECT_LT(told, 1.1 * target);
    EXPECT_GT(told, 0.6 * target);
    EXPECT_GT(t.paths, before);
    before = t.paths;
  }
  EXPECT_FALSE(paths_for(1e-4, *kit.tracer, *kit.elements, *kit.faces, kit.optics, loads, spec_of(64, 1)).enough);
}

TEST(PathErrors, BalanceClosesAndThreadsDoNotMatter) {
  const HeatKit kit = street();
  const Weather weather = summer_weather();
  const WeatherLoads loads = summer_loads(weather, spec_of(64, 1));
  std::vector<HeatResult> runs;
  for (const int threads : {1, 2}) {
    set_threads(threads);
    runs.push_back(kit.solve(loads, spec_of(64, 9)));
  }
  set_threads(0);
  const auto& b = runs[0].balance;
  const double takes = b.sunlight + b.infrared;
  std::printf("balance: %.0f W of sunlight, %.0f W of infrared, %.3f W are left (%.4f %% of sunlight)\n", b.sunlight,
              b.infrared, b.residual(), 100 * b.residual() / b.sunlight);
  EXPECT_LT(std::fabs(b.residual()), 1e-3 * b.sunlight);
  EXPECT_GT(takes, 0);
  EXPECT_EQ(runs[0].kelvin, runs[1].kelvin);
  EXPECT_EQ(runs[0].path_error, runs[1].path_error);
  EXPECT_EQ(runs[0].absorbed, runs[1].absorbed);
  EXPECT_EQ(runs[0].balance.residual(), runs[1].balance.residual());
}

}  // namespace
}  // namespace suite::path_errors_test
