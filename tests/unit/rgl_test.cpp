#include "formats/rgl/rgl.h"

#include <gtest/gtest.h>
#include <lzma.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "formats/merl/merl.h"
#include "support/tensor_file.h"

namespace suite {
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

std::vector<std::byte> unpack_xz(const std::string& path, size_t size) {
  const std::vector<std::byte> packed = read_bytes(path);
  std::vector<std::byte> raw(size);
  uint64_t limit = UINT64_MAX;
  size_t from = 0, to = 0;
  const lzma_ret code =
      lzma_stream_buffer_decode(&limit, 0, nullptr, reinterpret_cast<const uint8_t*>(packed.data()), &from,
                                packed.size(), reinterpret_cast<uint8_t*>(raw.data()), &to, raw.size());
  EXPECT_EQ(code, LZMA_OK);
  return raw;
}

// Independent truth: the same material evaluated by other people's reader into the MERL layout, bins at their centres.
TEST(Rgl, AgreesWithTheMerlTableOfTheSameMaterial) {
  const std::string folder = std::string(SUITE_LOCAL_DATA) + "/brdf/";
  if (!file_exists(folder + "chm_mint.binary.xz")) GTEST_SKIP() << "local data absent: " << folder;
  for (const std::string name : {"satin_purple", "chm_mint"}) {
    const auto brdf = read_rgl(folder + name + "_rgb.bsdf");
    const auto table = parse_merl(unpack_xz(folder + name + ".binary.xz", 34992012), name);
    size_t compared = 0;
    for (int i = 0; i < 90; ++i)
      for (int j = i % 3; j < 90; j += 3)
        for (int k = j % 7; k < 180; k += 7) {
          const MerlPair p = merl_bin_directions(i, j, k, 180);
          if (std::min(p.in.z, p.out.z) < std::cos(80 * kDegree))
            continue;  // both directions where the data are reliable
          double a[3], b[3];
          brdf->value(p.out, p.in, a);
          table->value(p.out, p.in, b);
          if (std::isnan(b[0])) continue;
          ++compared;
          // The other reader works in float throughout: up to 5e-5 of the brightest channel; the red of the chrome film
          // is often a difference near zero of values outside the gamut and has no relative precision of its own.
          const double tolerance = 1e-4 * std::max({b[0], b[1], b[2]});
          for (int c = 0; c < 3; ++c) ASSERT_NEAR(a[c], b[c], tolerance) << name << ' ' << i << ' ' << j << ' ' << k;
        }
    EXPECT_GT(compared, 20000u);
  }
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
}  // namespace suite
