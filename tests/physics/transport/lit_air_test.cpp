// Air that knows the scene: the field over an even ground, with what paths find of the scene in it, against paths that
// are scattered in the same layers every time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "math/stats.h"
#include "tests/support/lit_air_kit.h"

namespace suite::test::lit_air_test {
namespace {

struct View {
  std::shared_ptr<Scene> scene;
  std::vector<Ray> rays;
  double sun_zenith_deg = 50;
};
CaptureResult see(const View& view, AirSpec air, AirScattering scattering, bool adjacency, uint32_t paths) {
  air.scattering = scattering;
  air.adjacency = adjacency;
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  sources.add(SunSpec{{dir_from_angles(view.sun_zenith_deg * kDegree, 0.3), 0, Curve::constant(1)}});
  const std::vector<Band> bands{Band::rectangular("blue", 0.45, 0.01), Band::rectangular("red", 0.67, 0.01)};
  return render(view.scene, sources, std::make_unique<RaySensor>(view.rays, bands, paths, 0.02)).result;
}

// SUITE_LONG: so many times the paths; with 64 errors are some 0.2 %.
uint32_t many(uint32_t paths) {
  const char* factor = std::getenv("SUITE_LONG");
  return factor ? static_cast<uint32_t>(std::max(1, std::atoi(factor))) * paths : paths;
}
void tell(const char* what, const CaptureResult& lit, const CaptureResult& traced) {
  for (size_t i = 0; i < lit.radiance.size(); ++i)
    std::printf("%s %zu: %.5f +- %.5f, traced %.5f +- %.5f, off %.2f %%\n", what, i, lit.radiance[i],
                lit.standard_error[i], traced.radiance[i], traced.standard_error[i],
                100 * (lit.radiance[i] / traced.radiance[i] - 1));
}

// Squares of 1 km, black and white, over 24 km; grey around them.
View checkerboard() {
  std::vector<Vec3> corners;
  std::vector<uint32_t> faces[2];
  constexpr int n = 24;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = 1e3 * (i - n / 2), y = 1e3 * (j - n / 2);
      std::vector<uint32_t>& f = faces[(i + j) % 2];
      const auto first = static_cast<uint32_t>(corners.size());
      for (const Vec3 c : {Vec3{x, y, 0}, Vec3{x + 1e3, y, 0}, Vec3{x + 1e3, y + 1e3, 0}, Vec3{x, y + 1e3, 0}})
        corners.push_back(c);
      for (const uint32_t k : {0, 1, 2, 0, 2, 3}) f.push_back(first + k);
    }
  View view;
  view.scene =
      scene_of({mesh_of(corners, faces[0], 0), mesh_of(corners, faces[1], 1), quad(1e5, -1, 2)},
               {material("black", lambert(0)), material("white", lambert(0.8)), material("grey", lambert(0.4))});
  // On a square of each, and on a white one close to the edge.
  view.rays = {from_space({500, 500, 0}, 0, 0), from_space({500, 1500, 0}, 30, 1), from_space({950, 500, 0}, 0, 0)};
  return view;
}

// The field knows another ground (0.2) than the one that is there (0.4 in the mean), and no squares.
TEST(LitAir, SquaresShineIntoTheAirAboveTheirNeighbours) {
  const View view = checkerboard();
  const AirSpec air = haze(0.5);
  const CaptureResult traced = see(view, air, AirScattering::traced, false, many(40000)),
                      lit = see(view, air, AirScattering::diffuse, true, many(12000));
  EXPECT_LT(largest_z(lit, traced), kSigmas);
  tell("squares", lit, traced);
  for (size_t i = 0; i < lit.radiance.size(); ++i) {
    EXPECT_LT(lit.standard_error[i], 0.02 * lit.radiance[i]) << i;
    if (std::getenv("SUITE_LONG")) {
      EXPECT_NEAR(lit.radiance[i] / traced.radiance[i], 1, 0.01) << i;
    }
  }
  const CaptureResult even = see(view, air, AirScattering::diffuse, false, 2000);
  std::printf("control: %.1f errors\n", largest_z(even, traced));
  EXPECT_GT(largest_z(even, traced), kSigmas);  // control
}

// A wall of 2 km in the sun's way; views through the air in its shadow and beside it.
TEST(LitAir, ShadowsStandInTheAir) {
  View view;
  view.sun_zenith_deg = 70;
  const Dir sun = dir_from_angles(70 * kDegree, 0.3), across{-std::sin(0.3), std::cos(0.3), 0};
  const Vec3 foot{2000 * std::cos(0.3), 2000 * std::sin(0.3), 0};
  const auto at = [&](double side, double height) { return foot + across * side + Vec3{0, 0, height}; };
  view.scene = scene_of(
      {mesh_of({at(-8e3, 0), at(8e3, 0), at(8e3, 4e3), at(-8e3, 4e3)}, {0, 1, 2, 0, 2, 3}, 1), quad(1e5, 0, 0)},
      {material("ground", lambert(0.2)), material("wall", lambert(0.1))});
  // Level along the wall, in its shadow, and the sky seen from there; the last from beyond, in the light.
  view.rays = {{{0, 0, 500}, normalized(Vec3{across.x, across.y, -0.03}), 0},
               {{0, 0, 2}, normalized(Vec3{-sun.x, -sun.y, 1}), 0},
               {foot * 2 + Vec3{0, 0, 300}, normalized(Vec3{across.x, across.y, -0.03}), 0}};
  const AirSpec air = haze(0.4);
  const CaptureResult traced = see(view, air, AirScattering::traced, false, many(40000)),
                      lit = see(view, air, AirScattering::diffuse, true, many(12000));
  tell("shadows", lit, traced);
  EXPECT_LT(largest_z(lit, traced), kSigmas);
  const double control = largest_z(see(view, air, AirScattering::diffuse, false, 2000), traced);
  std::printf("control: %.1f errors\n", control);
  EXPECT_GT(control, kSigmas);
}

// Intervals of 95 % hold, with all that paths bring of the scene in the air: Student's t of 15 degrees of freedom,
// about the mean of all.
TEST(LitAir, IntervalsCover) {
  View view = checkerboard();
  constexpr uint32_t kTrials = 1500;
  view.rays.assign(kTrials, view.rays[1]);
  const CaptureResult r = see(view, haze(0.5), AirScattering::diffuse, true, 128);
  for (size_t band = 0; band < 2; ++band) {
    double mean = 0;
    for (size_t i = 0; i < kTrials; ++i) mean += r.radiance[2 * i + band] / kTrials;
    int covered = 0;
    const double t = student_t_quantile(0.95, static_cast<int>(r.error_degrees));
    for (size_t i = 0; i < kTrials; ++i)
      covered += std::fabs(r.radiance[2 * i + band] - mean) <= t * r.standard_error[2 * i + band];
    std::printf("coverage in air, band %zu: %.4f\n", band, covered / double{kTrials});
    EXPECT_GT(covered, 0.93 * kTrials);  // 3.6 standard deviations of the count
    EXPECT_LT(covered, 0.97 * kTrials);
  }
}

// Where the scene is the even ground nothing is added but noise; and where it stands in no way of light at all, none.
TEST(LitAir, AnEvenGroundAddsNothing) {
  View view;
  view.scene = scene_of({quad(1e5, 0, 0)}, {material("ground", lambert(0.2))});
  view.rays = {from_space({0, 0, 0}, 0, 0), from_space({0, 0, 0}, 50, 2)};
  const CaptureResult lit = see(view, haze(0.5), AirScattering::diffuse, true, 4000),
                      even = see(view, haze(0.5), AirScattering::diffuse, false, 4000);
  EXPECT_LT(largest_z(lit, even), kSigmas);
  view.scene = scene_of({quad(1, 0, 0)}, {material("ground", lambert(0.2))});
  view.rays = {{{0, 0, 1000}, normalized(Vec3{1, 0, 0.2}), 0}};
  const CaptureResult sky = see(view, haze(0.5), AirScattering::diffuse, true, 256),
                      known = see(view, haze(0.5), AirScattering::diffuse, false, 256);
  for (size_t i = 0; i < sky.radiance.size(); ++i)
    EXPECT_NEAR(sky.radiance[i], known.radiance[i], 1e-5 * known.radiance[i]);
}

// Nor where the scene is a piece of the even ground: ways past its edge end at the ground that lies there, and no light
// is scattered below.
TEST(LitAir, APieceOfTheEvenGroundAddsNothing) {
  View view;
  view.scene = scene_of({quad(400, 0, 0)}, {material("ground", lambert(0.2))});
  view.rays = {from_space({0, 0, 0}, 0, 0),
               from_space({390, 390, 0}, 30, 2),
               from_space({-390, 0, 0}, 0, 0),
               {{0, 0, 300}, normalized(Vec3{1, 0.2, -0.3}), 0}};
  const CaptureResult lit = see(view, haze(0.5), AirScattering::diffuse, true, 10000),
                      even = see(view, haze(0.5), AirScattering::diffuse, false, 10000);
  tell("piece", lit, even);
  // The piece sends up what the field's ground does, within 3e-4 of what is seen.
  for (size_t i = 0; i < lit.radiance.size(); ++i)
    EXPECT_NEAR(lit.radiance[i], even.radiance[i],
                kSigmas * std::hypot(lit.standard_error[i], even.standard_error[i]) + 3e-4 * even.radiance[i])
        << i;
}

// The parts of the light add up to it, and those of the air to its path radiance.
class Parts final : public RaySensor {
 public:
  using RaySensor::RaySensor;
  std::span<const std::string> channels() const override { return names_; }
  std::span<const std::string> truth() const override { return truth_; }

 private:
  std::vector<std::string> names_{"radiance", "unscattered", "direct", "diffuse", "adjacency", "path_radiance"};
  std::vector<std::string> truth_{"air_transmittance", "air_thermal", "air_single",
                                  "air_multiple",      "hits",        "air_water"};
};
TEST(LitAir, PartsAddUp) {
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(haze(0.3));
  sources.add(SunSpec{{dir_from_angles(50 * kDegree, 0.3), 0.0047, Curve::constant(1000)}});
  const std::vector<Band> bands{Band::rectangular("blue", 0.45, 0.01), Band::rectangular("thermal", 10, 0.1)};
  const auto scene = scene_of({quad(1e4, 0, 0)}, {material("ground", lambert(0.5))});
  const Rendered r = render(
      scene, sources,
      std::make_unique<Parts>(std::vector<Ray>{{{0, 0, 3000}, normalized(Vec3{0.5, 0, -1}), 0}}, bands, 2048, 0.02));
  const auto channel = [&](size_t c, size_t band) { return r.result.radiance[2 * c + band]; };
  for (size_t band = 0; band < 2; ++band) {
    double sum = 0;
    for (size_t c = 1; c < 5; ++c) sum += channel(c, band);
    EXPECT_NEAR(sum, channel(0, band), 1e-5 * channel(0, band)) << band;
    const auto truth = [&](size_t row) { return r.result.truth[2 * row + band]; };
    EXPECT_NEAR(truth(1) + truth(2) + truth(3), channel(5, band), 1e-4 * channel(5, band)) << band;
    EXPECT_GT(truth(0), 0.3);
    EXPECT_LT(truth(0), 0.99);
  }
  // Direct light is that of the beam, twice through the air.
  EXPECT_EQ(r.result.truth[8], 2048);  // hits: paths that go back to the air count as they first went
  EXPECT_GT(channel(2, 0), channel(3, 0));
  // US standard: 14.4 kg/m2 in all, two thirds of them below 3 km; the line of sight is slant.
  EXPECT_NEAR(r.result.truth[9], 10.3 * std::hypot(1, 0.5), 1.0);
  EXPECT_NE(channel(4, 0), 0);  // the ground is another one than the field's
  EXPECT_GT(r.result.truth[2 * 2], 0);
  EXPECT_LT(r.result.truth[2 * 1], 1e-6 * r.result.truth[2 * 2]);  // nothing thermal in blue light
}

}  // namespace
}  // namespace suite::test::lit_air_test
