// BPDFs and refracted diffuse light against closed forms.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "math/warps.h"
#include "optics/models.h"
#include "optics/models/bpdf.h"
#include "support/conformance.h"

namespace suite::bpdf_test {
namespace {

// Directions of light from theta_i to theta_s, phi_s = 0 forwards (degrees).
struct Pair {
  Dir out, in;
  Pair(double theta_i, double theta_s, double phi_s)
      : out(dir_from_angles(theta_s * kDegree, phi_s * kDegree)), in(dir_from_angles(theta_i * kDegree, kPi)) {}
};

// tests/data/polarisation/bpdf_reference.csv: first columns by formulas apart from ours.
TEST(Bpdf, MaignanAgreesWithTheTable) {
  std::ifstream file(SUITE_TEST_DATA "/polarisation/bpdf_reference.csv");
  int compared = 0;
  for (std::string line; std::getline(file, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    double c, ndvi, theta_i, theta_s, phi, incidence, r11, r21, r31;
    if (!(numbers >> c >> ndvi >> theta_i >> theta_s >> phi >> incidence >> r11 >> r21 >> r31)) continue;
    const Pair d(theta_i, theta_s, phi);
    const auto b = Bpdf(strf("maignan c %.17g ndvi %.17g", c, ndvi)).at(d.out, d.in);
    EXPECT_NEAR(b.r11, r11, 1e-6 * r11) << line;
    EXPECT_NEAR(b.r11 * b.matrix(1, 0), r21, 1e-6 * r11) << line;
    EXPECT_NEAR(b.r11 * b.matrix(2, 0), r31, 1e-6 * r11) << line;
    ++compared;
  }
  EXPECT_EQ(compared, 18);
}
// Fresnel's equations of n = 1.5 at half the phase angle, put into the published formulas apart from ours (NumPy).
TEST(Bpdf, OthersAgreeWithTheirFormulas) {
  const struct {
    double theta_i, theta_s, phi, soil, vegetation, mixed, nadal, nadal_polarised, litvinov;
  } rows[] = {
      {40, 40, 0, 1.948354038e-02, 7.462628919e-03, 1.227099350e-02, 1.930222123e-02, 1.326277121e-02, 4.131642933e-03},
      {60, 45, 60, 3.449455045e-02, 1.010321991e-02, 1.985975213e-02, 1.786517131e-02, 1.419221833e-02,
       1.835712181e-03},
      {60, 30, 135, 2.328916189e-02, 7.382368503e-03, 1.374508586e-02, 3.737178555e-02, 7.113421223e-03,
       2.396886657e-03}};
  for (const auto& r : rows) {
    const Pair d(r.theta_i, r.theta_s, r.phi);
    const auto r11 = [&](const char* text) { return Bpdf(text).at(d.out, d.in).r11; };
    EXPECT_NEAR(r11("breon cover 0"), r.soil, 1e-9 * r.soil + 1e-11);
    EXPECT_NEAR(r11("breon cover 1"), r.vegetation, 1e-9 * r.vegetation + 1e-11);
    EXPECT_NEAR(r11("breon cover 0.6"), r.mixed, 1e-9 * r.mixed + 1e-11);
    EXPECT_NEAR(r11("nadal_breon rho 0.0145 beta 120"), r.nadal, 1e-9 * r.nadal + 1e-11);
    EXPECT_NEAR(r11("litvinov"), r.litvinov, 1e-9 * r.litvinov + 1e-11);
    const auto b = Bpdf("nadal_breon beta 120 rho 0.0145").at(d.out, d.in);
    EXPECT_NEAR(b.r11 * std::hypot(b.matrix(1, 0), b.matrix(2, 0)), r.nadal_polarised, 1e-9);
  }
  for (const char* wrong : {"maignan c 6", "maignan c 6 ndvi", "maignan c x ndvi 0", "maignan c 6 ndvi 3", "breon",
                            "breon c 1", "rondeaux", "litvinov variance 0", "breon cover nan", "breon cover 1e999"})
    EXPECT_THROW(Bpdf{wrong}, Error) << wrong;
}
// The BRDF keeps its value; of that, R11 / pi is polarised as mirrors are, and never more than all of it.
TEST(Bpdf, IsAPartOfTheBrdf) {
  const SpectralState state = test::test_state(2);
  const auto made = [&](double level, const char* text) {
    ModelSpec spec{"rpv",
                   {},
                   {{"rho0", Curve::constant(level)}, {"k", Curve::constant(1)}, {"asymmetry", Curve::constant(0)}},
                   {{"bpdf", text}},
                   nullptr};
    check_model(spec);
    return bake(spec, state);
  };
  const char* const text = "maignan c 6.11 ndvi 0.5";
  const auto bright = made(0.3, text), dark = made(1e-4, text), plain = made(0.3, "");
  std::vector<float> w(state.size()), without(state.size());
  std::vector<Mueller> m(state.size());
  for (const Pair d : {Pair(40, 40, 0), Pair(60, 45, 60), Pair(89, 88, 20), Pair(50, 50, 180), Pair(0, 0, 0)}) {
    const auto b = Bpdf(text).at(d.out, d.in);
    bright->eval(d.out, d.in, w), plain->eval(d.out, d.in, without);
    EXPECT_EQ(w, without);
    EXPECT_EQ(bright->mueller(d.out, d.in, m).unknown, 0);
    EXPECT_NEAR(m[0](1, 0) * w[0] / d.in.z, b.r11 / kPi * b.matrix(1, 0), 1e-8);
    EXPECT_NEAR(m[0](2, 2) * w[0] / d.in.z, b.r11 / kPi * b.matrix(2, 2), 1e-7);
    EXPECT_EQ(plain->mueller(d.out, d.in, m).unknown, 1);
    if (d.in.z < 0.1) continue;
    dark->mueller(d.out, d.in, m);
    EXPECT_NEAR(m[0](1, 0), b.matrix(1, 0), 1e-12) << "all of it";
  }
  ModelSpec wrong{"ross_li", {{"isotropic", 0.1}, {"volume", 0}, {"geometry", 0}}, {}, {{"bpdf", "maignan"}}, nullptr};
  EXPECT_THROW(check_model(wrong, Where{"scene.yaml", 3, 1, {}, -1}), Error);
}

// Light that leaves a body of index 1.5 at 20, 40, 60, 75 and 85 deg (Wolff 1994): (T_p - T_s)/(T_p + T_s).
TEST(Bpdf, DiffuseLightIsPolarisedByItsRefraction) {
  const SpectralState state = test::test_state(2);
  ModelSpec spec{"coated",
                 {{"sigma", 0.3}},
                 {{"reflectance", Curve::constant(0.4)}, {"transmittance", Curve::constant(0.4)}},
                 {},
                 nullptr};
  check_model(spec);
  const auto model = bake(spec, state);
  const struct {
    double deg, degree;
  } rows[] = {{20, 0.0071006}, {40, 0.0329301}, {60, 0.0959415}, {75, 0.1958599}, {85, 0.3087441}};
  std::vector<Mueller> m(state.size());
  for (const auto& r : rows) {
    const Dir slant = dir_from_angles(r.deg * kDegree, 0.7), down{0, 0, -1};
    EXPECT_EQ(model->mueller(slant, down, m).unknown, 0);
    EXPECT_NEAR(m[0](1, 0), r.degree, 1e-7) << "out, p-polarised";
    EXPECT_NEAR(m[0](0, 1), 0, 1e-12);
    model->mueller(down, slant, m);
    EXPECT_NEAR(m[0](0, 1), r.degree, 1e-7) << "in";
  }
}

}  // namespace
}  // namespace suite::bpdf_test
