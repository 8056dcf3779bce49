// Contributions keep their times: histograms of arrival against closed forms, and their sums against steady images.
#include <gtest/gtest.h>

#include "tests/support/arrival_sink.h"
#include "tests/support/lamps_kit.h"
#include "tests/support/media_kit.h"

namespace suite::arrival_test {
namespace {

using namespace suite::test;

constexpr double kIntensity = 100;

SourceSpecs lamp_at(Vec3 place) {
  SourceSpecs sources;
  sources.add(point_lamp({place}, kIntensity));
  return sources;
}

// Sum of a histogram against the steady image of the same ray: within 3 sigma of both.
void expect_steady(const Arrivals& arrivals, const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
                   const Ray& ray, double precision) {
  const auto steady =
      render(scene, sources, std::make_unique<RaySensor>(std::vector<Ray>{ray}, one_band(), 1 << 15, 0.01, 1));
  const double error = std::hypot(arrivals.total.stderr_of_mean(), steady.result.standard_error[0]);
  EXPECT_NEAR(arrivals.total.mean(), steady.result.radiance[0], 3 * error);
  EXPECT_LT(error, precision * arrivals.total.mean());
}

// Two walls that meet in a corner: one facing the sensor, and the floor.
TEST(Arrivals, CornerOfTwoWalls) {
  const double rho = 0.5;
  const auto scene =
      scene_of({mesh_of({{5, -20, -1}, {5, 20, -1}, {5, 20, 20}, {5, -20, 20}}, {0, 2, 1, 0, 3, 2}, 0),
                mesh_of({{-20, -20, -1}, {5, -20, -1}, {5, 20, -1}, {-20, 20, -1}}, {0, 1, 2, 0, 2, 3}, 0)},
               {material("wall", lambert(rho))});
  const Vec3 lamp{2, 3, 1};
  const SourceSpecs sources = lamp_at(lamp);
  const Ray ray{{0, 0, 0}, {1, 0, 0}, 0};
  const double step = 0.25;
  const Arrivals arrivals(scene, sources, ray, 4, 200, step, 64, 1024);
  // First order: one reflection, at one distance.
  const Vec3 way = lamp - Vec3{5, 0, 0};
  const double d = length(way), expected = rho / kPi * (-way.x / d) * kIntensity / (d * d);
  const auto at = static_cast<size_t>((5 + d) / step);
  for (size_t i = 0; i <= 200; ++i)
    EXPECT_NEAR(arrivals.values[1][i].mean(), i == at ? expected : 0, 1e-5 * expected) << i;
  // Nothing reflected twice can arrive sooner than by way of the floor's nearest place: the mirror image of the lamp.
  const double least = 5 + length(Vec3{lamp.x, lamp.y, -2 - lamp.z} - Vec3{5, 0, 0});
  double second = 0;
  for (size_t i = 0; i <= 200; ++i) {
    second += arrivals.values[2][i].mean();
    if ((static_cast<double>(i) + 1) * step < least) {
      EXPECT_EQ(arrivals.values[2][i].mean(), 0) << i;
    }
  }
  EXPECT_GT(second, 0.01 * expected);
  expect_steady(arrivals, scene, sources, ray, 0.01);
}

// Single scattering of a lamp's light along a ray through a homogeneous medium, W/(m2 sr um), between two arrivals.
double scattered_once(double extinction, double scattering, double index, double beside, double from, double to) {
  // Along the ray at x the lamp is r = sqrt(x^2 + beside^2) away; arrival = index (x + r).
  const auto place = [&](double arrival) {
    const double s = arrival / index;
    return s <= beside ? 0.0 : (s * s - beside * beside) / (2 * s);
  };
  const double a = place(from), b = place(to);
  constexpr int n = 2000;  // midpoints
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double x = a + (b - a) * (i + 0.5) / n, r = std::hypot(x, beside);
    sum += scattering / (4 * kPi) * kIntensity / (r * r) * std::exp(-extinction * (x + r));
  }
  return sum * (b - a) / n;
}

void expect_fog(double index) {
  Medium fog = medium(Curve::constant(0.02), Curve::constant(0.08));
  fog.index = Curve::constant(index);
  // All space above a plane far below.
  auto scene = std::make_shared<Scene>();
  scene->media = {fog};
  scene->ambient = 0;
  scene->materials = {material("ground", lambert(0))};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0, translation({0, 0, -1000}));
  check_scene(*scene, "fog");
  const double beside = 4, step = 2;
  const SourceSpecs sources = lamp_at({0, beside, 0});
  const Ray ray{{0, 0, 0}, {1, 0, 0}, 0};
  const size_t bins = 20;
  // Many batches of few paths: stratified points of one batch cross the edge of a bin seldom, and then all at once.
  const Arrivals arrivals(scene, sources, ray, 3, bins, step, 1024, 128);
  double square = 0;
  int used = 0;
  for (size_t i = 0; i < bins; ++i) {
    const double from = static_cast<double>(i) * step;
    const double expected = scattered_once(0.1, 0.08, index, beside, from, from + step);
    const RunningStats& got = arrivals.values[1][i];
    if (expected == 0) {
      EXPECT_EQ(got.mean(), 0) << i;
      continue;
    }
    const double z = (got.mean() - expected) / got.stderr_of_mean();
    EXPECT_LT(std::fabs(z), 4) << i << ": " << got.mean() << " expected " << expected;
    square += z * z, ++used;
  }
  EXPECT_LT(square / used, 1 + 3 * std::sqrt(2.0 / used));  // 3 sigma of chi-square
  // A histogram that forgets the index is far off.
  if (index > 1) {
    double wrong = 0;
    for (size_t i = 4; i < bins; ++i) {
      const double from = static_cast<double>(i) * step, got = arrivals.values[1][i].mean();
      wrong = std::max(wrong, std::fabs(scattered_once(0.1, 0.08, 1, beside, from, from + step) - got) /
                                  arrivals.values[1][i].stderr_of_mean());
    }
    EXPECT_GT(wrong, 10);
  }
  expect_steady(arrivals, scene, sources, ray, 0.04);  // places beside the lamp make it noisy
}

TEST(Arrivals, Fog) { expect_fog(1); }
TEST(Arrivals, WaterIsSlower) { expect_fog(1.33); }

}  // namespace
}  // namespace suite::arrival_test
