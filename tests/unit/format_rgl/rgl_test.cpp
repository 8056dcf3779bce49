#include "formats/rgl/rgl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>

#include "base/error.h"
#include "base/files.h"
#include "formats/merl/merl.h"
#include "support/tensor_file.h"

namespace suite::format_rgl_rgl_test {
namespace {

using test::small_rgl;
using test::TensorFileBuilder;
constexpr float kFloatPi = 3.14159265f;

std::string message(const std::vector<std::byte>& bytes) {
  try {
    parse_rgl(bytes, "x.bsdf");
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

// With a uniform vndf the warp is the identity, so everything is known in closed form.
TEST(Rgl, UniformWarpGivesTheRamp) {
  const auto brdf = parse_rgl(small_rgl({0.0f}, 0).build(), "x.bsdf");
  EXPECT_TRUE(brdf->info().isotropic);
  EXPECT_TRUE(brdf->info().bilateral);
  const Dir in = dir_from_angles(0.35, 0.2), out = dir_from_angles(0.5, 1.9);  // in is half way between slices 0 and 1
  const Vec3 m = normalized(in + out);
  const double u = std::sqrt(polar_angle(m) * 2 / kPi);
  double f[3];
  brdf->value(out, in, f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(f[c], (1 + 2 * u) * (c + 1) * 1.5 * 2 / (4 * 0.5) / out.z, 1e-5);
  brdf->value(out, {0, 0, -1}, f);
  EXPECT_TRUE(std::isnan(f[0]));
}

TEST(Rgl, DivisionByTheCosineStopsAt88Degrees) {
  const auto brdf = parse_rgl(small_rgl({0.0f}, 0).build(), "x.bsdf");
  double a[3], b[3];
  brdf->value(dir_from_angles(88 * kDegree, 0), {0, 0, 1}, a);
  brdf->value(dir_from_angles(89.99 * kDegree, 0), {0, 0, 1}, b);
  EXPECT_NEAR(b[0] / a[0], 1, 0.02);
}

TEST(Rgl, SpectralChannels) {
  const auto brdf = parse_rgl(small_rgl({0.0f}, 5).build(), "x.bsdf");
  ASSERT_EQ(brdf->info().wavelength_um.size(), 5u);
  EXPECT_NEAR(brdf->info().wavelength_um[4], 0.44, 1e-6);
  double f[5];
  brdf->value({0, 0, 1}, {0, 0, 1}, f);
  for (int c = 0; c < 5; ++c) EXPECT_NEAR(f[c], 2.0 * (c + 1) / 2, 1e-5);
}

// Slices differ by azimuth: a half circle repeats after pi, a quadrant is mirrored.
TEST(Rgl, ReducedAzimuths) {
  struct Case {
    std::vector<float> phi;
    Dir in, same;
  };
  const Dir in = dir_from_angles(0.7, -2.5);
  const Case cases[] = {{{-kFloatPi, -kFloatPi / 2, 0}, in, {-in.x, -in.y, in.z}},
                        {{-kFloatPi, -3 * kFloatPi / 4, -kFloatPi / 2}, in, {in.x, -in.y, in.z}}};
  for (const Case& c : cases) {
    const auto brdf = parse_rgl(small_rgl(c.phi, 0).build(), "x.bsdf");
    EXPECT_FALSE(brdf->info().isotropic);
    double a[3], b[3];
    brdf->value({0, 0, 1}, c.in, a);
    brdf->value({0, 0, 1}, c.same, b);
    const double at = (c.phi[1] - c.phi[0]), slice = (-2.5 + kPi) / at;  // 0 and 1 are the first two azimuths
    const double u = std::sqrt(0.35 * 2 / kPi);
    EXPECT_NEAR(a[0], (1 + 2 * u) * (1 + 1 + 3 * slice), 1e-4);
    EXPECT_NEAR(b[0], a[0], 1e-6);
  }
  const auto whole = parse_rgl(small_rgl({-kFloatPi, 0, kFloatPi}, 0).build(), "x.bsdf");
  double a[3], b[3];
  whole->value({0, 0, 1}, in, a);
  whole->value({0, 0, 1}, {-in.x, -in.y, in.z}, b);
  EXPECT_GT(std::fabs(a[0] - b[0]), 1.0);
}

TEST(Rgl, RefusesWrongFiles) {
  std::vector<std::byte> good = small_rgl({0.0f}, 0).build();
  EXPECT_EQ(message(good), "accepted");
  auto changed = [&](size_t at, uint8_t value) {
    std::vector<std::byte> b = good;
    b[at] = std::byte(value);
    return message(b);
  };
  EXPECT_NE(changed(0, 'x').find("x.bsdf: byte 0: error: is not a tensor file"), std::string::npos);
  EXPECT_NE(changed(12, 9).find("version 9.0 is unknown"), std::string::npos);
  EXPECT_NE(changed(17, 255).find("more than the file can hold"), std::string::npos);
  for (size_t n = 0; n < good.size(); ++n)
    ASSERT_NE(message({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n)}), "accepted")
        << "truncated to " << n;

  TensorFileBuilder missing;
  missing.floats("phi_i", {1}, {0.0f});
  EXPECT_NE(message(missing.build()).find("field 'theta_i' is missing"), std::string::npos);
  EXPECT_NE(message(small_rgl({0.0f, 0.3f, 0.5f}, 0).build()).find("no symmetry completes"), std::string::npos);
  EXPECT_NE(message(small_rgl({0.0f}, 0, NAN).build()).find("'ndf' holds a value that is not finite"),
            std::string::npos);
  EXPECT_NE(message(small_rgl({0.0f}, 0, 1, -1).build()).find("'sigma' holds a negative value"), std::string::npos);
}

// Independent truth: the same materials evaluated by other people's reader at the centres of MERL's bins.
TEST(Rgl, AgreesWithAnotherReaderInMerlsBins) {
  std::ifstream in(SUITE_TEST_DATA "/brdf/rgl_in_merl_bins.csv");
  ASSERT_TRUE(in.is_open());
  std::string line;
  std::getline(in, line);
  std::map<std::string, std::shared_ptr<const RglBrdf>> materials;
  size_t compared = 0, told_apart = 0;
  while (std::getline(in, line)) {
    const std::string name = line.substr(0, line.find(','));
    int bin[3];
    double b[3];
    ASSERT_EQ(std::sscanf(line.c_str() + name.size(), ",%d,%d,%d,%lf,%lf,%lf", bin, bin + 1, bin + 2, b, b + 1, b + 2),
              6)
        << line;
    auto& brdf = materials[name];
    if (!brdf) brdf = read_rgl(std::string(SUITE_TEST_DATA) + "/brdf/" + name + "_rgb.bsdf");
    const MerlPair p = merl_bin_directions(bin[0], bin[1], bin[2], 180);
    if (std::min(p.in.z, p.out.z) < std::cos(80 * kDegree)) continue;  // both directions where the data are reliable
    ++compared;
    double a[3], other[3];
    brdf->value(p.out, p.in, a);
    brdf->value(dir_from_angles(std::acos(p.out.z) + 0.002, azimuth(p.out)), p.in, other);
    // The other reader works in float throughout: up to 5e-5 of the brightest channel; the red of the chrome film
    // is often a difference near zero of values outside the gamut and has no relative precision of its own.
    const double tolerance = 1e-4 * std::max({b[0], b[1], b[2]});
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(a[c], b[c], tolerance) << line;
    told_apart += std::fabs(other[1] - b[1]) > tolerance;  // negative control: a tenth of a degree off
  }
  EXPECT_EQ(materials.size(), 2u);
  EXPECT_GT(compared, 700u);
  EXPECT_GT(told_apart, compared / 2);
}

TEST(Rgl, ShippedSatinIsIsotropicAndBilateral) {
  const auto brdf = read_rgl(std::string(SUITE_TEST_DATA) + "/brdf/satin_purple_rgb.bsdf");
  EXPECT_TRUE(brdf->info().isotropic && brdf->info().bilateral);
  EXPECT_LT(brdf->asymmetry(), 1e-5);
  EXPECT_NE(brdf->description().find("Purple Satin"), std::string::npos);
  double f[3];
  brdf->value({0, 0, 1}, {0, 0, 1}, f);
  for (const double x : f) EXPECT_TRUE(x > 0.01 && x < 100) << x;
}

}  // namespace
}  // namespace suite::format_rgl_rgl_test
