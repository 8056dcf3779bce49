// Side flights towards the sun (techniques/side_vertex.h) against paths without them: the same means in every band,
// with less noise; and that a fault in how both ways are shared would be seen.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/media_kit.h"

namespace suite::test::side_flights_test {
namespace {

constexpr double kSigmas = 4.5;  // less than 1e-5 a comparison by chance

SourceSpecs sun(double half_angle) {
  SourceSpecs sources;
  sources.add(SunSpec{dir_from_angles(0.6, 1), half_angle, Curve::constant(2)});
  return sources;
}
const Ray kDown{{3, 0.5, 4}, normalized(Vec3{-3, -0.4, -4}), 0};

// Droplets of holes and uneven cells, partly inside of a ball of smoke that scatters otherwise in every band, beside a
// screen, over bright ground.
std::shared_ptr<Scene> cloud() {
  const Medium droplets =
      medium(Curve({0.4, 0.9}, {0, 0.1}, Outside::hold), Curve({0.4, 0.9}, {2, 4}, Outside::hold), hg(0.85));
  const Medium smoke = medium(Curve::constant(0.1), Curve({0.4, 0.9}, {2, 0.5}, Outside::hold),
                              {"hg", {}, {{"g", Curve({0.4, 0.9}, {0.8, 0.3}, Outside::hold)}}, {}, nullptr});
  auto scene = std::make_shared<Scene>();
  scene->media = {droplets, smoke};
  scene->materials = {material("ground", lambert(0.6)), boundary(1)};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -1.5}));
  place(*scene, PrimitiveKind::sphere, {0.8}, 1, translation({0.3, 0, 0}));
  place(*scene, PrimitiveKind::plane, {1, 1}, 0, translation({1.5, 0, 0.5}) * rotation({0, 1, 0}, 1.2));
  scene->grids.push_back(grid_of({6, 6, 6}, translation({-1, -1, -1}) * scaling({0.33, 0.33, 0.33}),
                                 [](uint32_t i, uint32_t j, uint32_t k) { return (i * j + k) % 4 * 0.8; }));
  scene->volumes.push_back({0, rotation({0, 1, 0}, 0.3)});
  check_scene(*scene, "cloud");
  return scene;
}

using Bands = std::vector<Repeated>;
Bands run(const std::shared_ptr<Scene>& scene, const SourceSpecs& sources, bool sides, uint32_t paths, uint64_t seed,
          uint32_t scatterings = 0) {
  PipelineOptions options;
  options.side_flights = sides;
  options.seed = seed;
  options.max_scatterings = scatterings;
  std::vector<Band> bands;
  for (const double center : {0.42, 0.6, 0.88}) bands.push_back(Band::rectangular("b", center, 0.01));
  const auto done = render(scene, sources, std::make_unique<RaySensor>(repeated(kDown), bands, paths, 0.01), options);
  EXPECT_EQ(done.report.statistics.failures, 0u);
  Bands result;
  for (size_t b = 0; b < bands.size(); ++b) result.push_back(over_problems(done.result, b));
  return result;
}

// Means must be the same, and known so well that `seen` of them would be seen.
void expect_same(const Bands& one, const Bands& other, double seen) {
  for (size_t b = 0; b < one.size(); ++b) {
    const Repeated &x = one[b], &y = other[b];
    const double noise = kSigmas * std::hypot(x.error, y.error);
    EXPECT_NEAR(x.mean, y.mean, noise) << b;
    EXPECT_LT(noise, seen * y.mean) << b;
  }
}

TEST(SideFlights, SameMeansUnderADisk) {
  const auto scene = cloud();
  expect_same(run(scene, sun(0.1), true, 1 << 9, 1), run(scene, sun(0.1), false, 1 << 9, 2), 0.13);
}

TEST(SideFlights, SameMeansUnderCollimatedLight) {
  const auto scene = cloud();
  expect_same(run(scene, sun(0), true, 1 << 9, 3), run(scene, sun(0), false, 1 << 9, 4), 0.13);
}

// A thick cloud, what they are for. Their variances are half of those without in long runs (4096 paths in each of 64
// problems, four seeds: 0.50); short ones see less of the rare events that make up the other half (1024: 0.64).
TEST(SideFlights, LessNoiseInAThickCloud) {
  auto scene = scene_with(medium(Curve::constant(0), Curve::constant(6), hg(0.85)),
                          grid_of({1, 1, 1}, translation({-1, -1, -1}) * scaling({2, 2, 2}),
                                  [](uint32_t, uint32_t, uint32_t) { return 1.0; }));
  double with = 0, without = 0;
  for (uint64_t seed = 10; seed < 12; ++seed) {
    const Bands a = run(scene, sun(0.005), true, 1 << 10, seed), b = run(scene, sun(0.005), false, 1 << 10, seed + 100);
    expect_same(a, b, 0.3);
    with += a[0].error * a[0].error, without += b[0].error * b[0].error;
  }
  EXPECT_LT(with, 0.8 * without);
}

// Light that is scattered twice at most comes by the first side flight alone, or by the path's own second event.
TEST(SideFlights, OfTwoScatterings) {
  const auto scene = cloud();
  const Bands with = run(scene, sun(0), true, 1 << 11, 5, 2), without = run(scene, sun(0), false, 1 << 12, 6, 2),
              once = run(scene, sun(0), true, 1 << 11, 7, 1);
  expect_same(with, without, 0.15);
  // Control: without the second scattering something would be missing.
  for (size_t b = 0; b < 3; ++b)
    EXPECT_GT(without[b].mean - once[b].mean, 2 * kSigmas * std::hypot(once[b].error, without[b].error)) << b;
}

}  // namespace
}  // namespace suite::test::side_flights_test
