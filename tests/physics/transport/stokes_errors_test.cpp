// Covariances of I, Q and U: how often their regions of 95 % hold what the mean of all says.
#include <gtest/gtest.h>

#include "math/warps.h"
#include "tests/support/stokes_kit.h"

namespace suite::test::stokes_errors_test {
namespace {

// 1000 pixels see the same with numbers of their own, of a fixed seed: a share of 0.95 has a standard error of 0.7 %,
// and is between 0.93 and 0.97 but once in 270 times.
constexpr size_t kPixels = 1000;

struct Seen {
  std::vector<std::array<double, 3>> S;
  std::vector<std::array<double, 6>> C;
  std::array<double, 3> mean{};
  double degrees = 0;
};
Seen see(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, const Ray& ray, Polarimetry how = {}) {
  const auto run =
      render(scene, sources, std::make_unique<StokesRays>(std::vector<Ray>(kPixels, ray), 64, std::move(how)));
  Seen seen;
  seen.degrees = run.result.error_degrees;
  for (const StokesSeen& s : seen_of(run.result)) seen.S.push_back({s.S[0], s.S[1], s.S[2]});
  seen.C.resize(kPixels);
  for (size_t i = 0; i < kPixels; ++i) {
    std::copy_n(&run.result.stokes_covariance[i * 6], 6, seen.C[i].begin());
    for (size_t c = 0; c < 3; ++c) seen.mean[c] += seen.S[i][c] / kPixels;
  }
  return seen;
}
// Share of pixels whose region holds (q, u). size: what the covariances are multiplied by.
double held(const Seen& seen, double q, double u, double size = 1) {
  const double reach = joint_reach(0.95, seen.degrees);
  size_t in = 0;
  for (size_t i = 0; i < kPixels; ++i) {
    double C[6];
    std::copy_n(seen.C[i].begin(), 6, C);
    for (double& c : C) c *= size;
    in += in_region(seen.S[i][1] - q, seen.S[i][2] - u, C, reach);
  }
  return static_cast<double>(in) / kPixels;
}
Ray towards(Vec3 at, double angle, double azimuth) {
  const Dir d = dir_from_angles(kPi - angle, azimuth);
  return {at - d * 5, d, 0};
}
ModelSpec metal(double roughness) {
  return {"ggx", {{"roughness", roughness}}, {{"n", Curve::constant(1.39)}, {"k", Curve::constant(7.65)}}, {}, nullptr};
}
SourceSpecs sky() {
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  return sources;
}
// Correlation of the errors of Q and U: as the pixels say of themselves, and by their scatter.
std::array<double, 2> correlation(const Seen& seen) {
  double told[3] = {}, found[3] = {};
  for (size_t i = 0; i < kPixels; ++i) {
    const double q = seen.S[i][1] - seen.mean[1], u = seen.S[i][2] - seen.mean[2];
    for (size_t k = 0; k < 3; ++k) told[k] += seen.C[i][3 + k];
    found[0] += q * q, found[1] += q * u, found[2] += u * u;
  }
  return {told[1] / std::sqrt(told[0] * told[2]), found[1] / std::sqrt(found[0] * found[2])};
}
void expect_covered(const Seen& seen) {
  EXPECT_GE(held(seen, seen.mean[1], seen.mean[2]), 0.93);
  EXPECT_LE(held(seen, seen.mean[1], seen.mean[2]), 0.97);
  EXPECT_LT(held(seen, seen.mean[1], seen.mean[2], 0.25), 0.9) << "negative control: errors half as large";
  const auto [told, found] = correlation(seen);
  EXPECT_NEAR(told, found, 0.13) << "four standard errors of a correlation of 1000 pixels";
}

TEST(StokesErrors, RegionsHoldTheLightOfAir) {
  const ModelSpec rayleigh{"rayleigh", {{"depolarisation", 0.0279}}, {}, {}, nullptr};
  const auto scene = slab_scene(medium(Curve::constant(0), Curve::constant(1), rayleigh), 1);
  SourceSpecs sources;
  sources.add(SunSpec{{dir_from_angles(60 * kDegree, 0.6), 0, Curve::constant(1)}});
  expect_covered(see(scene, sources, towards({}, 40 * kDegree, 1.3)));
}
// In a frame turned by 22.5 degrees the covariance of Q and U is half the difference of the variances before.
TEST(StokesErrors, CovariancesTurnWithTheFrame) {
  const auto scene = scene_of({quad(100, 0, 0)}, {material("metal", metal(0.4))});
  const Ray ray = towards({}, 75 * kDegree, 0.4);
  const PolarFrame frame = meridian_frame(-ray.direction);
  Polarimetry how;
  how.frame = StokesFrame::image;
  how.up = frame.e1 * std::cos(22.5 * kDegree) + frame.e2 * std::sin(22.5 * kDegree);
  const Seen seen = see(scene, sky(), ray), turned = see(scene, sky(), ray, how);
  expect_covered(seen);
  size_t wrong_sign = 0;
  for (size_t i = 0; i < kPixels; ++i) {
    const double wanted = 0.5 * (seen.C[i][5] - seen.C[i][3]), size = seen.C[i][5] + seen.C[i][3];
    EXPECT_NEAR(turned.C[i][4], wanted, 1e-4 * size);
    wrong_sign += std::fabs(-turned.C[i][4] - wanted) < 1e-4 * size;
  }
  EXPECT_LT(wrong_sign, kPixels / 20) << "negative control";
}
// Rough metal that stands upright on a matte floor, and shows it and the sky.
TEST(StokesErrors, RegionsHoldTheLightOfAWall) {
  const auto scene =
      scene_of({quad(100, 0, 0), mesh_of({{3, -9, 0}, {3, 9, 0}, {3, 9, 9}, {3, -9, 9}}, {0, 2, 1, 0, 3, 2}, 1)},
               {material("floor", lambert(0.3)), material("wall", metal(0.5))});
  expect_covered(see(scene, sky(), towards({3, 0, 3}, 100 * kDegree, 0.5)));
}
// A wall that does not polarise, of 64 paths a pixel: what is seen straight from above of rough metal is unpolarised
// for symmetry, but no sample is. Its debiased degree is 0 within its interval; of a polarised one it is not.
TEST(StokesErrors, ADepolarisingWallShowsNoDegreeBeyondItsInterval) {
  const auto scene = scene_of({quad(100, 0, 0)}, {material("metal", metal(0.4))});
  const Seen none = see(scene, sky(), towards({}, 0, 0)), some = see(scene, sky(), towards({}, 75 * kDegree, 0.4));
  EXPECT_GE(held(none, 0, 0), 0.93);
  EXPECT_LE(held(none, 0, 0), 0.97);
  EXPECT_LT(held(some, 0, 0), 0.1) << "negative control";
  // Matte walls have no noise of polarisation at all, whatever the light.
  const Seen matte = see(scene_of({quad(100, 0, 0)}, {material("matte", lambert(0.4))}), sky(), towards({}, 0.7, 0));
  for (size_t i = 0; i < kPixels; ++i) EXPECT_EQ(matte.S[i][1], 0);
}

}  // namespace
}  // namespace suite::test::stokes_errors_test
