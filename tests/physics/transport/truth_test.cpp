// Closed forms of light between surfaces: penumbra of a disk sun, one bounce between two plates, infinite parallel
// plates, a spherical cavity. Every comparison would refuse a value 2 % off.
#include <gtest/gtest.h>

#include <cmath>

#include "spectral/planck.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::truth_test {
namespace {

void expect_mean(const CaptureResult& r, double truth, size_t problem = 0) {
  const double L = r.radiance[problem], se = r.standard_error[problem];
  EXPECT_NEAR(L, truth, 4.5 * se + 5e-5 * truth);
  EXPECT_LT(se, 4e-3 * truth);
  EXPECT_GT(std::fabs(L - 1.02 * truth), 4.5 * se + 5e-5 * truth);
}

// Irradiance, as a share of the whole disk's, left by a plate that covers what lies beyond x / z > t. In X = x / z,
// Y = y / z the measure of cos d(omega) is dX dY / (1 + X^2 + Y^2)^2; the disk of half angle a is X^2 + Y^2 < tan^2 a.
double share_before_edge(double t, double a) {
  const double R = std::tan(a);
  double part = 0, whole = 0;
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    const double X = -R + 2 * R * (i + 0.5) / n, Y = std::sqrt(R * R - X * X), q = 1 + X * X;
    // Integral over Y from -Y to Y of (q + Y^2)^-2.
    const double strip = Y / (q * (q + Y * Y)) + std::atan(Y / std::sqrt(q)) / std::pow(q, 1.5);
    whole += strip;
    if (X < t) part += strip;
  }
  return part / whole;
}

TEST(Penumbra, EdgeBeforeTheSun) {
  // A sun overhead, the edge of a black plate 1 m above the floor, places across the penumbra.
  for (const double half_angle : {0.00465, 0.1}) {
    SourceSpecs s;
    s.add(SunSpec{{{0, 0, 1}, half_angle, Curve::constant(1000)}});
    const Mesh plate = mesh_of({{0, -2, 1}, {2, -2, 1}, {2, 2, 1}, {0, 2, 1}}, {0, 1, 2, 0, 2, 3}, 1);
    const auto scene =
        scene_of({quad(2, 0, 0), plate}, {material("floor", lambert(0.5)), material("plate", lambert(0))});
    std::vector<Ray> rays;
    std::vector<double> truth;
    for (const double share : {-0.9, -0.5, 0.0, 0.3, 0.6}) {
      // At x the edge stands at X = -x.
      const Vec3 at{share * std::tan(half_angle), 0, 0}, from = at + Vec3{-0.5, 0.1, 0.3};
      rays.push_back({from, normalized(at - from), 0});
      truth.push_back(0.5 / kPi * 1000 * share_before_edge(-at.x, half_angle));
    }
    const auto run = render(scene, s, std::make_unique<RaySensor>(rays, one_band(), 1 << 15));
    for (size_t i = 0; i < rays.size(); ++i) {
      SCOPED_TRACE(i);
      expect_mean(run.result, truth[i], i);
    }
  }
}

TEST(TwoPlates, OneBounce) {
  // A disk of radius R lit from straight below with E over a small disk of radius r that shades its middle: the small
  // one sees rho2 E / pi over the ring, F = R^2 / (R^2 + h^2) - r^2 / (r^2 + h^2) (Howell B-15), and sends rho1 F rho2
  // E / pi. The small one is so small that what it sends back to the large one does not show (2e-5); paths must not be
  // cut, since what is cut counts in the standard error.
  const double R = 1, r = 0.01, h = 0.7, E = 700, rho1 = 0.6, rho2 = 0.8;
  auto scene =
      std::make_shared<Scene>(*scene_of({}, {material("low", lambert(rho1)), material("high", lambert(rho2))}));
  scene->primitives = {{"low", PrimitiveKind::disk, {r, 0}, 0}, {"high", PrimitiveKind::disk, {R, 0}, 1}};
  for (uint32_t i = 0; i < 2; ++i) {
    Placement p;
    p.kind = TargetKind::primitive;
    p.target = i;
    p.to_parent = translation({0, 0, i * h});
    scene->groups[0].placements.push_back(p);
  }
  check_scene(*scene, "test scene");
  SourceSpecs s;
  s.add(SunSpec{{{0, 0, -1}, 0, Curve::constant(E)}});
  const Vec3 from{0.3, 0.2, 0.25};
  const auto run = render(
      scene, s, std::make_unique<RaySensor>(std::vector<Ray>{{from, normalized(-from), 0}}, one_band(), 1 << 14));
  expect_mean(run.result, rho1 * (R * R / (R * R + h * h) - r * r / (r * r + h * h)) * rho2 * E / kPi);
}

TEST(ParallelPlates, ThermalExchange) {
  // Two infinite grey plates face each other: J1 = (e1 B1 + (1 - e1) e2 B2) / (1 - (1 - e1)(1 - e2)).
  Material low = material("low", lambert(0.3)), high = material("high", lambert(0.6));
  low.temperature_k = 330, high.temperature_k = 280;
  auto scene = std::make_shared<Scene>(*scene_of({}, {low, high}));
  scene->primitives = {{"low", PrimitiveKind::plane, {0, 0}, 0}, {"high", PrimitiveKind::plane, {0, 0}, 1}};
  for (uint32_t i = 0; i < 2; ++i) {
    Placement p;
    p.kind = TargetKind::primitive;
    p.target = i;
    p.to_parent = translation({0, 0, i * 1.0});
    scene->groups[0].placements.push_back(p);
  }
  check_scene(*scene, "test scene");
  PipelineOptions options;
  options.max_nodes = 40;
  const auto run = render(scene, {},
                          std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 0.5}, dir_from_angles(2.5, 1), 0},
                                                                       {{0, 0, 0.5}, dir_from_angles(0.4, 1), 0}},
                                                      std::vector<Band>{Band::rectangular("lwir", 10, 1)}, 1 << 14, 2),
                          options);
  const double B1 = planck_band_radiance(9.5, 10.5, 330), B2 = planck_band_radiance(9.5, 10.5, 280);
  auto facing = [](double e1, double b1, double e2, double b2) {
    return (e1 * b1 + (1 - e1) * e2 * b2) / (1 - (1 - e1) * (1 - e2));
  };
  expect_mean(run.result, facing(0.7, B1, 0.4, B2), 0);
  expect_mean(run.result, facing(0.4, B2, 0.7, B1), 1);
}

TEST(Cavity, EffectiveEmissivity) {
  // An isothermal sphere with a hole of share f of its surface: e' = e / (1 - (1 - e)(1 - f)), from any direction.
  const int rings = 90, around = 180, open = 15;
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  for (int r = 0; r <= rings; ++r)
    for (int k = 0; k < around; ++k) v.push_back(dir_from_angles(kPi * r / rings, 2 * kPi * k / around));
  for (int r = open; r < rings; ++r)
    for (int k = 0; k < around; ++k) {
      const auto i = static_cast<uint32_t>(r * around + k), j = static_cast<uint32_t>(r * around + (k + 1) % around),
                 w = static_cast<uint32_t>(around);
      for (const uint32_t n : {i, j, j + w, i, j + w, i + w}) f.push_back(n);
    }
  const double e = 0.5, hole = 0.5 * (1 - std::cos(kPi * open / rings)), B = planck_band_radiance(9.5, 10.5, 350);
  Material wall = material("wall", lambert(1 - e));
  wall.temperature_k = 350;
  PipelineOptions options;
  options.max_nodes = 40;
  const auto run =
      render(scene_of({mesh_of(v, f, 0)}, {wall}), {},
             std::make_unique<RaySensor>(
                 std::vector<Ray>{{{0.1, 0, 3}, {0, 0, -1}, 0}, {{0.5, 0, 2}, normalized(Vec3{-0.5, 0.1, -2.4}), 0}},
                 std::vector<Band>{Band::rectangular("lwir", 10, 1)}, 1 << 14, 2),
             options);
  for (size_t i = 0; i < 2; ++i) expect_mean(run.result, B * e / (1 - (1 - e) * (1 - hole)), i);
}

}  // namespace
}  // namespace suite::test::truth_test
