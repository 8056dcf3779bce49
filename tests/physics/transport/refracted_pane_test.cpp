// A floor under panes of glass: light through two and four smooth interfaces, and what they reflect on its way.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "optics/fresnel.h"
#include "tests/support/pipeline_kit.h"

namespace suite::test::refracted_pane_test {
namespace {

constexpr double kGlass = 1.5, kReflectance = 0.3;

// Panes 10 mm thick, 0.1 m apart.
std::shared_ptr<Scene> floor_under(int panes) {
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("floor", lambert(kReflectance)),
                      material("glass", {"dielectric", {}, {{"index", Curve::constant(kGlass)}}, {}, nullptr})};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  for (int i = 0; i < panes; ++i) place(*scene, PrimitiveKind::box, {0, 0, 1 + 0.1 * i, 0, 0, 1.01 + 0.1 * i}, 1);
  check_scene(*scene, "panes");
  return scene;
}

// Parallel faces of reflectance R, with all reflections between them (one polarisation state for all, as the suite has
// it): their R / (1 - R) add up, as layers that send on all that they do not reflect do (Stokes 1862). Straight
// through one pane: (1 - R)^2.
double reflectance(double cosine) { return fresnel_dielectric(cosine, kGlass).reflectance; }
double straight(double c) { return (1 - reflectance(c)) * (1 - reflectance(c)); }
double through(double c, int panes = 1) { return (1 - reflectance(c)) / (1 + (2 * panes - 1) * reflectance(c)); }

// Means over cosine-distributed directions.
template <class F>
double diffuse(const F& f) {
  constexpr int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += 2 * (i + 0.5) / n * f((i + 0.5) / n) / n;
  return sum;
}

// Radiance of the floor: what comes down, and what it and the pane throw to and fro.
double floor_radiance(double down, int panes = 1) {
  const double back = diffuse([&](double c) { return 1 - through(c, panes); });
  return kReflectance / kPi * down / (1 - kReflectance * back);
}

// Seen from between the pane and the floor.
Seen run(const SourceSpecs& sources, uint32_t paths, int panes = 1) {
  const Dir view = dir_from_angles(20 * kDegree, 0.4);
  return see(floor_under(panes), sources, RaySensor(std::vector<Ray>{{view * 0.5, -view, 0}}, one_band(), paths));
}

SourceSpecs sun(double half_angle, double zenith) {
  SourceSpecs s;
  s.add(SunSpec{dir_from_angles(zenith, 0), half_angle, Curve::constant(1)});
  return s;
}

void expect(const Seen& r, double truth) {
  const double mean = r.radiance[0], error = r.standard_error[0];
  SCOPED_TRACE(testing::Message() << mean << " +- " << error << " for " << truth);
  std::printf("%.5f +- %.2f %%, off %+.2f %%\n", mean, 100 * error / truth, 100 * (mean / truth - 1));
  EXPECT_NEAR(mean, truth, 0.005 * truth);
  EXPECT_NEAR(mean, truth, 5 * error + 2e-5 * truth);
  EXPECT_LE(r.missing[0], 1e-3 * truth);  // flagged as not resolved beyond
}

// With what the faces throw to and fro on its way: 0.2 % near the normal, 0.8 % at 60 degrees, 13 % at 80.
TEST(RefractedPane, CollimatedSun) {
  for (const double zenith : {5.0, 60.0, 80.0}) {
    const double c = std::cos(zenith * kDegree);
    expect(run(sun(0, zenith * kDegree), zenith < 70 ? 4096 : 32768), floor_radiance(c * through(c)));
  }
  // Negative control: the straight way alone would be told apart.
  const double c = std::cos(60 * kDegree);
  EXPECT_LT(straight(c), 0.993 * through(c));
}

// Four faces: more than ways through one pane can have.
TEST(RefractedPane, DoubleGlazing) {
  for (const double zenith : {5.0, 60.0}) {
    const double c = std::cos(zenith * kDegree);
    expect(run(sun(0, zenith * kDegree), 20480, 2), floor_radiance(c * through(c, 2), 2));
  }
}

// Bug: what the faces of three panes or more throw to and fro between them was lost without a word (of five at 60
// degrees 23 %), as was all light behind more than ten faces at 60 degrees, where the straight line was taken to be
// totally reflected in the glass.
TEST(RefractedPane, MoreFacesThanAreAskedThroughAreSaid) {
  constexpr struct {
    double zenith;
    int panes;
  } kStacks[] = {{5, 5}, {60, 4}, {60, 5}, {60, 6}, {60, 20}};
  for (const auto& [zenith, panes] : kStacks) {
    const double c = std::cos(zenith * kDegree), truth = floor_radiance(c * through(c, panes), panes);
    const Seen r = run(sun(0, zenith * kDegree), 1024, panes);
    std::printf("%2d panes, %2.0f degrees: %.5f +- %.5f of %.5f, missing %.5f\n", panes, zenith, r.radiance[0],
                r.standard_error[0], truth, r.missing[0]);
    EXPECT_NEAR(r.radiance[0] + r.missing[0], truth, 0.01 * truth + 4 * r.standard_error[0]);
    EXPECT_GT(r.missing[0], 0.04 * truth);
    if (panes <= 5) {
      EXPECT_LT(r.missing[0], 0.25 * truth);
    }
  }
}

// Bug: of a wide disk continuations met what the faces had reflected, so rarely that most runs missed it, and were low
// by 0.9 % at 60 degrees with an error that did not tell.
TEST(RefractedPane, WideSun) {
  constexpr double kDisk = 8 * kDegree;
  for (const double zenith : {5.0, 60.0}) {
    const Frame frame = Frame::around(dir_from_angles(zenith * kDegree, 0));
    double down = 0;
    constexpr int n = 300;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double c = 1 - (i + 0.5) / n * (1 - std::cos(kDisk)), r = std::sqrt(1 - c * c),
                     phi = 2 * kPi * (j + 0.5) / n, z = frame.to_world({r * std::cos(phi), r * std::sin(phi), c}).z;
        down += z * through(z) / (n * n);
      }
    down *= 2 * (1 - std::cos(kDisk)) / (std::sin(kDisk) * std::sin(kDisk));
    expect(run(sun(kDisk, zenith * kDegree), 4096), floor_radiance(down));
  }
}

TEST(RefractedPane, SunAndSky) {
  for (const double zenith : {5.0, 60.0}) {
    const double c = std::cos(zenith * kDegree);
    SourceSpecs s = sun(0, zenith * kDegree);
    s.add(uniform_sky(0.1, false));
    expect(run(s, 16384), floor_radiance(c * through(c) + kPi * 0.1 * diffuse([](double z) { return through(z); })));
  }
}

}  // namespace
}  // namespace suite::test::refracted_pane_test
