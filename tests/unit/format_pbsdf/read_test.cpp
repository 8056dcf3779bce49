// Measured Mueller matrices of tensor files, beside what Mitsuba reads in them.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "formats/pbsdf/pbsdf.h"
#include "support/mueller_formula.h"

namespace suite::format_pbsdf_read_test {
namespace {

using test::MuellerFormula;

std::string message(const std::vector<std::byte>& bytes) {
  try {
    parse_pbsdf(bytes, "x.pbsdf");
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

// f M between the meridian frames, linear between nodes and wavelengths.
Mueller interpolated(const sqt::MuellerBrdf& brdf, Dir out, Dir in, double um) {
  const sqt::MuellerBrdf::Data& d = brdf.data();
  const sqt::HalfGrid::Corners c = d.grid.at(sqt::HalfAngles::of(out, in));
  const sqt::GridPlace w = sqt::place_in(d.wavelength_um, um);
  Mueller m;
  for (size_t k = 0; k < 8; ++k)
    for (size_t e = 0; e < 16; ++e) {
      const auto of = [&](size_t channel) {
        return static_cast<double>(d.values[(c.node[k] * d.wavelength_um.size() + channel) * 16 + e]);
      };
      m.m[e] += c.weight[k] * ((1 - w.t) * of(w.low) + w.t * of(w.high));
    }
  return ScatteringPlane(out, in).turned(m);
}

struct Line {
  Dir out, in;
  double um;
  Mueller m;
};
std::vector<Line> mitsuba() {
  std::ifstream file(SUITE_TEST_DATA "/polarisation/measured_mueller.csv");
  std::vector<Line> lines;
  for (std::string text; std::getline(file, text);) {
    if (text.empty() || text[0] == '#' || text[0] == 't') continue;
    std::istringstream cells(text);
    std::vector<double> v;
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
    Line l{dir_from_angles(v[0] * kDegree, v[1] * kDegree), dir_from_angles(v[2] * kDegree, v[3] * kDegree), v[4], {}};
    std::copy_n(v.begin() + 5, 16, l.m.m.begin());
    lines.push_back(l);
  }
  return lines;
}

double worst_beside_mitsuba(const sqt::MuellerBrdf& brdf, const StokesConvention& wrong) {
  double worst = 0;
  for (const Line& l : mitsuba()) {
    const Mueller m = converted(interpolated(brdf, l.out, l.in, l.um), wrong);
    for (size_t e = 0; e < 16; ++e) worst = std::max(worst, std::fabs(m.m[e] - l.m.m[e]) / l.m.m[0]);
  }
  return worst;
}

TEST(Pbsdf, AgreesWithMitsuba) {
  const auto brdf = parse_pbsdf(MuellerFormula().pbsdf().build(), "metal.pbsdf");
  ASSERT_EQ(mitsuba().size(), 24u);
  EXPECT_LT(worst_beside_mitsuba(*brdf, {"", "", {1, 1, 1, 1}}), 2e-5);
  EXPECT_GT(worst_beside_mitsuba(*brdf, {"", "", {1, 1, 1, -1}}), 0.01) << "V of the other sign is seen";
  EXPECT_GT(worst_beside_mitsuba(*brdf, {"", "", {1, -1, -1, 1}}), 0.01) << "and axes that are swapped";
  EXPECT_EQ(brdf->info().name, "metal");
  EXPECT_EQ(brdf->info().wavelength_um.size(), 5u);
  EXPECT_EQ(brdf->data().grid.phi_d.size(), 12u) << "180 degrees are -180";
  EXPECT_EQ(brdf->missing_share(), 0);
  EXPECT_TRUE(brdf->info().bilateral);
  std::vector<double> f(5);
  const Line l = mitsuba()[1];
  brdf->value(l.out, l.in, f);
  EXPECT_NEAR(f[0], l.m.m[0], 1e-5);
  brdf->value(l.out, {0, 0, -1}, f);
  EXPECT_TRUE(std::isnan(f[0]));
}

// What is missing takes what is next to it; the other side of a half is its mirror image.
TEST(Pbsdf, FillsWhatIsMissing) {
  MuellerFormula formula;
  std::vector<float> values;
  formula.every([&](double h, double d, double p, double nm) {
    const bool there = h < 60;
    for (const double x : MuellerFormula::at(h * kDegree, d * kDegree, p * kDegree, nm).m)
      values.push_back(there ? static_cast<float>(x) : std::nanf(""));
  });
  auto b = formula.pbsdf();
  b.replace_floats("M", values);
  const auto brdf = parse_pbsdf(b.build(), "x.pbsdf");
  EXPECT_GT(brdf->missing_share(), 0.02);
  const auto& d = brdf->data();
  const size_t at = d.grid.node(3, 1, 5), near = d.grid.node(3, 1, 4);
  for (size_t e = 0; e < 16; ++e) EXPECT_EQ(d.values[at * 80 + e], d.values[near * 80 + e]);
}

TEST(Pbsdf, HalfACircleIsMirrored) {
  MuellerFormula formula;
  formula.phi_d_deg = {0, 45, 90, 135, 180};
  const auto half = parse_pbsdf(formula.pbsdf().build(), "x.pbsdf");
  EXPECT_EQ(half->data().grid.phi_d.size(), 8u);
  const Dir out = dir_from_angles(0.7, 0.3), in = dir_from_angles(0.5, 1.9);
  const Mueller m = interpolated(*half, out, in, 0.55),
                mirrored = interpolated(*half, {out.x, -out.y, out.z}, {in.x, -in.y, in.z}, 0.55);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(mirrored(i, j), m(i, j) * ((i < 2) == (j < 2) ? 1 : -1), 1e-7);
}

TEST(Pbsdf, RefusesWhatIsNone) {
  MuellerFormula formula;
  formula.phi_d_deg = {-20, 0, 20};
  EXPECT_NE(message(formula.pbsdf().build()).find("phi_d leaves out"), std::string::npos)
      << message(formula.pbsdf().build());
  formula = {};
  formula.theta_h_deg[2] = 4;
  EXPECT_NE(message(formula.pbsdf().build()).find("theta_h must ascend"), std::string::npos);
  auto b = MuellerFormula().pbsdf();
  b.replace_floats("M", std::vector<float>(13 * 6 * 7 * 5 * 16, std::nanf("")));
  EXPECT_NE(message(b.build()).find("no matrix above the horizon"), std::string::npos);
  test::TensorFileBuilder empty;
  empty.floats("M", {1}, {0});
  EXPECT_NE(message(empty.build()).find("'phi_d' is missing"), std::string::npos) << message(empty.build());
  auto bytes = MuellerFormula().pbsdf().build();
  bytes.resize(bytes.size() - 5);
  EXPECT_NE(message(bytes).find("beyond the end"), std::string::npos);
}

}  // namespace
}  // namespace suite::format_pbsdf_read_test
