// The wind-roughened sea: glint of the sun against the closed form of Cox & Munk, rendered; energy at all winds.
#include "optics/models/sea.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/radiometry_kit.h"

namespace suite::test::sea_test {
namespace {

constexpr double kIndex = 1.34;
ModelSpec sea(double wind, double directed = 0, double whitecaps = 0, double below = 0) {
  return {
      "sea", {{"wind_m_s", wind}, {"directed", directed}, {"whitecaps", whitecaps}, {"below", below}}, {}, {}, nullptr};
}

// Fresnel's equations as textbooks have them.
double fresnel(double cosine) {
  const double t = std::sqrt(1 - (1 - cosine * cosine) / (kIndex * kIndex));
  const double s = (cosine - kIndex * t) / (cosine + kIndex * t), p = (kIndex * cosine - t) / (kIndex * cosine + t);
  return 0.5 * (s * s + p * p);
}
// Smith's function for a normal distribution of slopes of variance s2 in the direction's plane.
double smith(Dir d, double s2) {
  const double v = d.z / std::sqrt(2 * s2 * (1 - d.z * d.z));
  return 0.5 * (std::exp(-v * v) / (v * std::sqrt(kPi)) - std::erfc(v));
}
// Radiance over irradiance (on a plane facing the sun): F P(slopes) / (4 cos(view) cos^4(tilt)), with shadows.
double glint(Dir sun, Dir view, double along, double across) {
  const Dir h = normalized(sun + view);
  const double zx = -h.x / h.z, zy = -h.y / h.z;
  const double p = std::exp(-0.5 * (zx * zx / along + zy * zy / across)) / (2 * kPi * std::sqrt(along * across));
  const auto in_plane = [&](Dir d) {
    const double s2 = d.x * d.x + d.y * d.y;
    return s2 > 0 ? (along * d.x * d.x + across * d.y * d.y) / s2 : along;
  };
  const double shadows = 1 / (1 + smith(sun, in_plane(sun)) + smith(view, in_plane(view)));
  return fresnel(dot(sun, h)) * p * shadows / (4 * view.z * std::pow(h.z, 4));
}

struct Geometry {
  double wind, sun_deg, view_deg, turned_deg;  // turned: azimuth of the view from the specular one
};
// 20 geometries from the specular point outwards; slopes up to some 1.5 standard deviations.
constexpr std::array<Geometry, 20> kGeometries{{{2, 20, 20, 0},   {2, 30, 20, 10}, {2, 40, 45, 5},  {2, 60, 60, 0},
                                                {4, 10, 10, 90},  {4, 30, 40, 15}, {4, 50, 40, 0},  {6, 20, 35, 20},
                                                {6, 45, 45, 10},  {6, 60, 50, 0},  {8, 1, 1, 0},    {8, 30, 10, 40},
                                                {8, 55, 60, 10},  {10, 40, 20, 0}, {10, 25, 50, 0}, {10, 70, 65, 5},
                                                {12, 35, 35, 30}, {12, 60, 40, 0}, {14, 20, 50, 0}, {14, 45, 30, 45}}};

double rendered(const ModelSpec& spec, Dir sun, Dir view) {
  const auto scene = scene_of({quad(1000, 0, 0)}, {material("sea", spec)});
  SourceSpecs sources;
  sources.add(SunSpec{sun, 0.27 * kDegree, Curve::constant(1)});
  const auto run =
      render(scene, sources, std::make_unique<RaySensor>(std::vector<Ray>{{view * 10.0, -view, 0}}, one_band(), 1024));
  EXPECT_EQ(run.report.statistics.failures, 0u);
  EXPECT_LT(run.result.standard_error[0], 2e-3 * run.result.radiance[0]);
  return run.result.radiance[0];
}

TEST(SeaGlint, IsTheClosedFormOfCoxAndMunk) {
  double worst = 0;
  for (const Geometry& g : kGeometries) {
    const Dir sun = dir_from_angles(g.sun_deg * kDegree, 0.3),
              view = dir_from_angles(g.view_deg * kDegree, 0.3 + kPi + g.turned_deg * kDegree);
    const double each = 0.5 * (0.003 + 0.00512 * g.wind), truth = glint(sun, view, each, each);
    const double error = rendered(sea(g.wind), sun, view) / truth - 1;
    EXPECT_NEAR(error, 0, 0.01) << g.wind << " m/s, sun " << g.sun_deg << ", view " << g.view_deg << ", "
                                << g.turned_deg;
    worst = std::max(worst, std::fabs(error));
  }
  std::printf("sun glint, 20 geometries, 2 to 14 m/s: within %.2f %%\n", 100 * worst);
}

TEST(SeaGlint, FollowsTheWindsDirection) {
  for (const double azimuth : {0.0, 45.0, 90.0}) {
    const Dir sun = dir_from_angles(40 * kDegree, azimuth * kDegree),
              view = dir_from_angles(20 * kDegree, (180 + azimuth) * kDegree);
    const double truth = glint(sun, view, 0.00316 * 8, 0.003 + 0.00192 * 8);
    EXPECT_NEAR(rendered(sea(8, 1), sun, view) / truth, 1, 0.01) << azimuth;
  }
  // Negative control: the same slopes in all directions are told apart.
  const Dir sun = dir_from_angles(40 * kDegree, 0), view = dir_from_angles(20 * kDegree, kPi);
  EXPECT_GT(std::fabs(rendered(sea(8), sun, view) / glint(sun, view, 0.00316 * 8, 0.003 + 0.00192 * 8) - 1), 0.02);
}

TEST(Sea, WhitecapsAreThePublishedShare) {
  EXPECT_NEAR(whitecap_share(10), 2.95e-6 * std::pow(10, 3.52), 1e-12);
  // Far from the glint only foam is seen: share x 0.22 / pi x cosine of the sun.
  const Dir sun = dir_from_angles(10 * kDegree, 0), view = dir_from_angles(70 * kDegree, 0);
  const double foam = whitecap_share(12) * kFoamReflectance / kPi * std::cos(10 * kDegree);
  const double glitter =
      (1 - whitecap_share(12)) * glint(sun, view, 0.5 * (0.003 + 0.00512 * 12), 0.5 * (0.003 + 0.00512 * 12));
  EXPECT_NEAR(rendered(sea(12, 0, -1), sun, view) / (foam + glitter), 1, 0.01);
}

// What enters and comes back whole loses nothing: a furnace, from calm to storm, nadir to grazing, both kinds of
// slopes.
TEST(Sea, KeepsEnergy) {
  for (const double wind : {0.0, 8.0, 14.0, 30.0}) {  // 8, directed: the tables of FollowsTheWindsDirection
    const auto scene = scene_of({quad(1000, 0, 0)}, {material("sea", sea(wind, wind == 8 ? 1 : 0, -1, 1))});
    SourceSpecs sources;
    sources.add(uniform_sky(1, true));
    std::vector<Ray> rays;
    for (const double zenith : {0.0, 30.0, 60.0, 75.0, 85.0}) {
      const Dir view = dir_from_angles(zenith * kDegree, 0.7);
      rays.push_back({view * 10.0, -view, 0});
    }
    const double white = whitecap_share(wind), expected = 1 - white * (1 - kFoamReflectance);
    const auto run = render(scene, sources, std::make_unique<RaySensor>(rays, one_band(), 16384));
    for (size_t i = 0; i < rays.size(); ++i)
      EXPECT_NEAR(run.result.radiance[i] / expected, 1, 4e-3 + 4 * run.result.standard_error[i])
          << wind << " m/s, view " << i;
  }
}

}  // namespace
}  // namespace suite::test::sea_test
