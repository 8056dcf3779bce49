#include "formats/merl/merl.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"

namespace suite::format_merl_merl_test {
namespace {

// f depends on both directions and is neither reciprocal nor mirror symmetric.
class Lopsided final : public sqt::Function {
 public:
  Lopsided() { info_.wavelength_um = {0.65, 0.55, 0.45}; }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    const double turn = azimuth(in) - azimuth(out);
    for (size_t c = 0; c < 3; ++c)
      f[c] = static_cast<double>(c + 1) *
             (1 + 0.3 * out.z + 0.1 * std::sin(turn) * std::hypot(in.x, in.y) * std::hypot(out.x, out.y));
  }

 private:
  Info info_;
};

std::vector<std::byte> file_bytes(int a, int b, int c, const std::vector<double>& raw) {
  std::vector<std::byte> bytes(12 + raw.size() * 8);
  const int32_t dims[3] = {a, b, c};
  std::memcpy(bytes.data(), dims, 12);
  std::memcpy(bytes.data() + 12, raw.data(), raw.size() * 8);
  return bytes;
}

TEST(Merl, BinDirectionsFallIntoTheirOwnBin) {
  for (const int phis : {180, 360}) {
    size_t above = 0;
    for (int i = 0; i < 90; ++i)
      for (int j = 0; j < 90; ++j)
        for (int k = 0; k < phis; ++k) {
          const MerlPair p = merl_bin_directions(i, j, k, phis);
          if (!(p.in.z > 0 && p.out.z > 0)) continue;
          ++above;
          ASSERT_NEAR(length(p.in), 1, 1e-12);
          ASSERT_EQ(merl_bin(p.out, p.in, phis), static_cast<size_t>(k + phis * (j + 90 * i)))
              << i << ' ' << j << ' ' << k;
          // The same pair turned about the normal is the same bin.
          const Affine3 r = rotation({0, 0, 1}, 1.234);
          ASSERT_EQ(merl_bin(r.vector(p.out), r.vector(p.in), phis), static_cast<size_t>(k + phis * (j + 90 * i)));
        }
    if (phis == 180) {
      EXPECT_EQ(above, 1096216u);  // the published count of bins above the horizon at their centres
    }
  }
}

TEST(Merl, NormalAndGrazingDirectionsStayInside) {
  const size_t n = size_t{90} * 90 * 180;
  for (const Dir d : {Dir{0, 0, 1}, dir_from_angles(89.999 * kDegree, 0.3), dir_from_angles(1e-9, 2)})
    for (const Dir e :
         {Dir{0, 0, 1}, dir_from_angles(89.999 * kDegree, 0.3 + kPi), dir_from_angles(89.999 * kDegree, 0.3)})
      EXPECT_LT(merl_bin(d, e, 180), n);
}

TEST(Merl, ScalesAndInvalidTriples) {
  const size_t n = size_t{90} * 90 * 180;
  std::vector<double> raw(3 * n, 1500.0);
  const MerlPair p = merl_bin_directions(3, 20, 50, 180), q = merl_bin_directions(3, 20, 51, 180),
                 nan = merl_bin_directions(3, 20, 52, 180);
  raw[n + merl_bin(q.out, q.in, 180)] = -1e-9;  // one negative channel rejects the triple
  raw[2 * n + merl_bin(nan.out, nan.in, 180)] = NAN;
  const MerlTable table("made up", 180, raw);
  double f[3];
  table.value(p.out, p.in, f);
  EXPECT_FLOAT_EQ(f[0], 1);
  EXPECT_FLOAT_EQ(f[1], 1.15f);
  EXPECT_FLOAT_EQ(f[2], 1.66f);
  for (const MerlPair& bad : {q, nan}) {
    table.value(bad.out, bad.in, f);
    for (const double x : f) EXPECT_TRUE(std::isnan(x));
  }
  table.value({0, 0, -1}, {0, 0, 1}, f);
  EXPECT_TRUE(std::isnan(f[0]));
  EXPECT_EQ(table.invalid_bins(), 2u);
  EXPECT_TRUE(table.info().bilateral);
}

TEST(Merl, WriteThenReadKeepsEveryBin) {
  const std::string path = testing::TempDir() + "/lopsided.binary";
  const Lopsided f;
  for (const int phis : {180, 360}) {
    write_merl(path, f, phis);
    const auto table = read_merl(path);
    EXPECT_EQ(table->phi_d_bins(), phis);
    EXPECT_EQ(table->invalid_bins(), 0u);
    EXPECT_FALSE(table->info().bilateral);
    for (int i = 0; i < 60; i += 7)
      for (int j = 0; j < 60; j += 7)
        for (int k = 0; k < phis; k += 11) {
          const MerlPair p = merl_bin_directions(i, j, k, phis);
          if (!(p.in.z > 0 && p.out.z > 0)) continue;
          double expected[3], got[3];
          f.value(p.out, p.in, expected);
          table->value(p.out, p.in, got);
          for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], expected[c], 2e-7 * expected[c]);
        }
  }
  std::filesystem::remove(path);
}

TEST(Merl, RefusesWrongFiles) {
  const std::vector<double> few(10);
  auto message = [](const std::vector<std::byte>& bytes) -> std::string {
    try {
      parse_merl(bytes, "x.binary");
    } catch (const Error& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_NE(message(file_bytes(90, 90, 90, few)).find("x.binary: byte 0: error: dimensions 90 x 90 x 90"),
            std::string::npos)
      << message(file_bytes(90, 90, 90, few));
  EXPECT_NE(message(file_bytes(90, 90, 180, few)).find("has 92 bytes, a 90 x 90 x 180 table has 34992012"),
            std::string::npos);
  EXPECT_NE(message({}).find("ends within the three dimensions"), std::string::npos);
  EXPECT_NE(
      message(file_bytes(90, 90, 180, std::vector<double>(size_t{3} * 1458000, -1.0))).find("no bin above the horizon"),
      std::string::npos);
}

}  // namespace
}  // namespace suite::format_merl_merl_test
