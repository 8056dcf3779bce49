// Mueller matrices of models: published and independent tables, and what every matrix must satisfy.
#include <gtest/gtest.h>

#include <complex>
#include <fstream>
#include <sstream>

#include "math/sampling.h"
#include "math/warps.h"
#include "optics/fresnel.h"
#include "optics/fresnel_mueller.h"
#include "optics/models.h"
#include "optics/phase_function.h"
#include "support/conformance.h"
#include "support/model_examples.h"
#include "support/polarisation_page.h"

namespace suite::mueller_test {
namespace {

struct Line {
  std::string name;            // the first cell where it is no number
  std::vector<double> values;  // of the others
};
std::vector<Line> table(const std::string& name) {
  std::ifstream file(SUITE_TEST_DATA "/polarisation/" + name);
  std::vector<Line> lines;
  bool heads = false;
  for (std::string text; std::getline(file, text);) {
    if (text.empty() || text[0] == '#' || !std::exchange(heads, true)) continue;
    Line line;
    std::istringstream cells(text);
    for (std::string cell; std::getline(cells, cell, ',');) {
      char* end = nullptr;
      const double x = std::strtod(cell.c_str(), &end);
      if (*end)
        line.name = cell;
      else
        line.values.push_back(x);
    }
    lines.push_back(line);
  }
  return lines;
}
// Directions of light from theta_i to theta_s, phi_s = 0 forwards (degrees).
struct Pair {
  Dir out, in;
  Pair(double theta_i, double theta_s, double phi_s)
      : out(dir_from_angles(theta_s * kDegree, phi_s * kDegree)), in(dir_from_angles(theta_i * kDegree, kPi)) {}
};
std::unique_ptr<const ScatterModel> baked(ModelSpec spec, const SpectralState& state) {
  check_model(spec);
  return bake(spec, state);
}

TEST(Mueller, FresnelAgreesWithTheTable) {
  const auto lines = table("fresnel_mueller.csv");
  ASSERT_EQ(lines.size(), 70u);
  for (const Line& l : lines) {
    const auto& v = l.values;
    const PlaneBlocks b = fresnel_reflection(std::cos(v[2] * kDegree), {v[0], v[1]});
    EXPECT_NEAR(b.a, v[3], 1e-9) << v[0] << ' ' << v[1] << ' ' << v[2];
    EXPECT_NEAR(b.b, v[4], 1e-9);
    EXPECT_NEAR(b.c, v[5], 1e-9);
    EXPECT_NEAR(b.d, v[6], 1e-9);
  }
}
TEST(Mueller, FresnelAgreesWithTheScalarFunctions) {
  for (const double n : {0.5, 0.75, 1.0, 1.33, 1.5, 4.0})
    for (double deg = 0; deg < 90; deg += 3.7) {
      const double c = std::cos(deg * kDegree);
      const Fresnel f = fresnel_dielectric(c, n);
      EXPECT_NEAR(fresnel_reflection(c, n).a, f.reflectance, 1e-12) << n << ' ' << deg;
      EXPECT_NEAR(fresnel_transmission(c, n).a, f.transmittance, 1e-12) << n << ' ' << deg;
      EXPECT_NEAR(fresnel_reflection(c, {n, 2.5}).a, fresnel_conductor(c, n, 2.5), 1e-12) << n << ' ' << deg;
    }
  EXPECT_EQ(fresnel_reflection(0.3, 1.0).b, 0);  // nothing there
  EXPECT_NEAR(fresnel_reflection(std::cos(std::atan(1.5)), 1.5).a, -fresnel_reflection(std::cos(std::atan(1.5)), 1.5).b,
              1e-15);  // Brewster: s alone
}
// Retardance of total reflection 2 atan(cos sqrt(sin^2 - 1/n^2) / sin^2) (Born & Wolf, section 1.5.4), n = 1.5.
TEST(Mueller, TotalReflectionRetards) {
  const struct {
    double deg, retardance;
  } rows[] = {{45, 36.86990}, {60, 40.45908}, {50.22945, 45}, {53.25823, 45}, {51.67118, 45.23973}};
  for (const auto& r : rows) {
    const PlaneBlocks b = fresnel_reflection(std::cos(r.deg * kDegree), 1 / 1.5);
    EXPECT_NEAR(b.a, 1, 1e-14);
    EXPECT_NEAR(b.b, 0, 1e-14);
    EXPECT_NEAR(std::fabs(std::remainder(std::atan2(b.d, b.c) / kDegree, 360)), r.retardance, 1e-5) << r.deg;
  }
  // Fresnel's rhomb: two such reflections make circular light of light at 45 deg.
  const Mueller once = fresnel_reflection(std::cos(50.22945 * kDegree), 1 / 1.5).matrix();
  const Stokes s = once * once * Stokes{1, 0, 1, 0};
  EXPECT_NEAR(std::fabs(s[3]), 1, 1e-9);
  EXPECT_NEAR(s[2], 0, 1e-6);
}
// Light through 1, 4 and 10 plates at Brewster's angle, n = 1.5, repeated reflections left out: (T_p - T_s)/(T_p + T_s)
// with T_s^(2 m) of Fresnel.
TEST(Mueller, PilesOfPlatesPolarise) {
  const double c = std::cos(std::atan(1.5));
  const PlaneBlocks b = fresnel_transmission(c, 1.5);
  EXPECT_NEAR(b.a + b.b, 1, 1e-14);                             // all of p
  EXPECT_NEAR(b.a - b.b, 1 - std::pow(1.25 / 3.25, 2), 1e-12);  // s: 1 - ((n^2 - 1)/(n^2 + 1))^2
}
TEST(Mueller, OneFacetAgreesWithTheTable) {
  const auto lines = table("facet_mueller.csv");
  ASSERT_EQ(lines.size(), 20u);
  for (const Line& l : lines) {
    const auto& v = l.values;
    const Pair d(v[2], v[3], v[4]);
    const PlaneBlocks b = fresnel_reflection(std::clamp(dot(d.out, normalized(d.out + d.in)), 0.0, 1.0), {v[0], v[1]});
    const Mueller m = ScatteringPlane(d.out, d.in).matrix(b * (1 / b.a));
    EXPECT_NEAR(b.a, v[5], 1e-9);
    for (size_t i = 1; i < 16; ++i)
      EXPECT_NEAR(m.m[i], v[5 + i], 1e-8) << v[2] << ' ' << v[3] << ' ' << v[4] << ' ' << i;
  }
}

// Models against SCATMECH (NIST): Gaussian slopes of s = sqrt(2) sigma with the shadowing of Torrance & Sparrow.
TEST(Mueller, PriestGermerAgreesWithScatmech) {
  const SpectralState state = test::test_state(1);
  int compared = 0;
  std::string made;
  std::unique_ptr<const ScatterModel> model;
  for (const Line& l : table("scatmech_mueller_brdf.csv")) {
    if (l.name.find("facet_gauss_TS") == std::string::npos) continue;
    const bool glass = l.name.find("glass") != std::string::npos;
    const double s = l.name.find("s0.1") != std::string::npos ? 0.1 : 0.3;
    if (std::exchange(made, l.name) != l.name)
      model = baked({"priest_germer",
                     {{"sigma", s / std::sqrt(2.0)}},
                     {{"index", Curve::constant(glass ? 1.5 : 1.39)},
                      {"absorption", Curve::constant(glass ? 0 : 7.65)},
                      {"diffuse", Curve::constant(0)}},
                     {},
                     nullptr},
                    state);
    const auto& v = l.values;
    const Pair d(v[0], v[1], v[2]);
    std::vector<float> w(state.size());
    std::vector<Mueller> m(state.size());
    model->eval(d.out, d.in, w);
    const auto of = model->mueller(d.out, d.in, m);
    EXPECT_EQ(of.unknown, 0);
    EXPECT_NEAR(w[0] / d.in.z, v[3], 1e-6 * v[3] + 3e-45) << l.name << ", down to what a float holds";
    const Mueller theirs = converted(m[0], kStokesConventions[1]);
    for (size_t i = 1; i < 16; ++i) EXPECT_NEAR(theirs.m[i], v[3 + i] / v[3], 1e-6) << l.name << ' ' << i;
    ++compared;
  }
  EXPECT_EQ(compared, 32);
}

// Whatever shadows facets, the matrix over m11 is Fresnel's of the one that mirrors: all rows of facets, with four laws
// of shadowing.
TEST(Mueller, FacetsOfEveryShadowingAgreeWithScatmech) {
  int compared = 0;
  for (const Line& l : table("scatmech_mueller_brdf.csv")) {
    if (l.name.find("facet_gauss") == std::string::npos) continue;
    const auto& v = l.values;
    const Pair d(v[0], v[1], v[2]);
    const std::complex<double> index =
        l.name.find("glass") != std::string::npos ? std::complex<double>(1.5, 0) : std::complex<double>(1.39, 7.65);
    const double cosine = dot(d.out, normalized(d.out + d.in));
    const PlaneBlocks f = fresnel_reflection(cosine, index);
    const Mueller theirs = converted(ScatteringPlane(d.out, d.in).matrix(f * (1 / f.a)), kStokesConventions[1]);
    for (size_t i = 1; i < 16; ++i) EXPECT_NEAR(theirs.m[i], v[3 + i] / v[3], 1e-6) << l.name << ' ' << i;
    ++compared;
  }
  EXPECT_EQ(compared, 96);
}

// Every model's matrices: m11 is what eval says (by definition 1), they exist, and what is reciprocal in intensity is
// so as a matrix: M(in -> out) = D M(-out -> -in)^T D with D = diag(1, 1, -1, 1). With roles of out and in exchanged
// the directions of travel are reversed.
struct Checked {
  double least = 1, reciprocity = 0, column = 0;
};
Checked check(const ScatterModel& model, const SpectralState& state, bool flip = false) {
  Pcg32 random(7);
  Checked worst;
  std::vector<Mueller> there(state.size()), back(state.size());
  std::vector<float> w(state.size()), w_back(state.size());
  for (int n = 0; n < 300; ++n) {
    Dir a = cosine_hemisphere({random.uniform(), random.uniform()}),
        b = cosine_hemisphere({random.uniform(), random.uniform()});
    if (n % 2) b = normalized(Dir{-a.x, -a.y, a.z} + (b - Dir{0, 0, 1}) * 1e-2);
    if (!model.opaque() && n % 4 == 0) b.z = -b.z;
    if (std::fabs(a.z) < 1e-3 || std::fabs(b.z) < 1e-3) continue;
    const auto one = model.mueller(a, b, there), two = model.mueller(b, a, back);
    model.eval(a, b, w), model.eval(b, a, w_back);
    const bool dark = std::min(w[0], w_back[0]) < 1e-25f;  // next to what a float holds
    for (size_t i = 0; i < (one.grey ? 1 : there.size()); ++i) {
      Mueller m = there[i];
      if (flip) m(0, 1) = -m(0, 1);
      EXPECT_NEAR(m(0, 0), 1, 1e-12);
      worst.least = std::min(worst.least, least_coherency(m));
      worst.column = std::max(worst.column, std::hypot(m(1, 0), m(2, 0), m(3, 0)));
      const Mueller r = converted(back[two.grey ? 0 : i].transposed(), {"", "", {1, 1, -1, 1}});
      for (size_t e = 0; e < 16 && !dark; ++e)
        worst.reciprocity = std::max(worst.reciprocity, std::fabs(m.m[e] - r.m[e]));
    }
  }
  return worst;
}
// How much of its light a model knows the matrix of, in the words of docs/theory/polarisation.md.
struct Known {
  double least = 1, most = 0, polarises = 0;
  void add(double unknown, double column) {
    least = std::min(least, unknown), most = std::max(most, unknown), polarises = std::max(polarises, column);
  }
  const char* name() const {
    if (least == 1) return "not known";
    if (most > 1e-12) return "partly";
    return polarises > 1e-6 ? "matrix" : "depolarises";
  }
};
Known known(const ScatterModel& model, size_t bins) {
  Pcg32 random(3);
  std::vector<Mueller> m(bins);
  std::vector<float> w(bins);
  Known of;
  for (int n = 0; n < 100; ++n) {
    const Dir out = cosine_hemisphere({random.uniform(), random.uniform()});
    Dir in = cosine_hemisphere({random.uniform(), random.uniform()});
    if (model.has_delta()) {
      const auto drawn = model.sample(out, {0.3, 0.4}, random.uniform(), 0);
      if (!drawn || !drawn->delta) continue;
      const auto p = model.delta_mueller(out, drawn->lobe, 0, m);
      of.add(p.unknown, std::fabs(m[0](2, 2)));
      continue;
    }
    if (n % 2) in = normalized(Dir{-out.x, -out.y, out.z} + (in - Dir{0, 0, 1}) * 1e-2);
    model.eval(out, in, w);
    if (!(w[0] > 1e-20f) || in.z < 1e-2) continue;
    const auto p = model.mueller(out, in, m);
    of.add(p.unknown, std::hypot(m[0](1, 0), m[0](2, 0)));
  }
  return of;
}
TEST(Mueller, MatricesOfAllModelsExistAndAreReciprocal) {
  const SpectralState state = test::test_state(4);
  const auto page = test::polarisation_of("Surface models");
  EXPECT_EQ(test::names_on_page("Surface models"), test::row_names(models()));
  int polarising = 0;
  for (const ModelRow& row : models())
    for (const ModelSpec& spec : test::examples_of(row)) {
      const auto model = baked(spec, state);
      const std::string of = known(*model, state.size()).name();
      const auto said = page.find(row.name);
      EXPECT_TRUE(said != page.end() && said->second.find(of) != std::string::npos) << row.name << " is: " << of;
      const Checked worst = check(*model, state);
      EXPECT_GT(worst.least, -1e-6) << row.name;
      EXPECT_LT(worst.column, 1 + 1e-9) << row.name;
      EXPECT_LT(worst.reciprocity, 1e-5) << row.name;
      if (worst.column < 0.1) continue;
      ++polarising;
      EXPECT_LT(check(*model, state, true).least, -1e-4) << row.name << ": a wrong sign is found";
    }
  EXPECT_GE(polarising, 8);
}

// Cox & Munk's slopes without shadowing: the ratios of the sea's first column are those of one facet, whatever shadows.
TEST(Mueller, GlitterIsPolarisedAsItsFacetsAre) {
  const SpectralState state = test::test_state(1);
  for (const Line& l : table("cox_munk_mueller.csv")) {
    const auto& v = l.values;
    const auto model =
        baked({"sea", {{"wind_m_s", v[0]}, {"whitecaps", 0}}, {{"index", Curve::constant(1.34)}}, {}, nullptr}, state);
    const Pair d(v[1], v[2], v[3]);
    std::vector<Mueller> m(state.size());
    const auto of = model->mueller(d.out, d.in, m);
    // What is not known to be polarised dilutes both alike.
    EXPECT_LT(of.unknown, 0.05);
    EXPECT_NEAR(m[0](1, 0), (1 - of.unknown) * v[5] / v[4], 1e-6) << v[0] << ' ' << v[1] << ' ' << v[3];
    EXPECT_NEAR(m[0](2, 0), (1 - of.unknown) * v[6] / v[4], 1e-6);
  }
}

TEST(Mueller, ThePageSaysWhatPhaseFunctionsDo) {
  const SpectralState state = test::test_state(2);
  const auto page = test::polarisation_of("Phase functions");
  EXPECT_EQ(test::names_on_page("Phase functions"), test::row_names(phases()));
  std::vector<PlaneBlocks> b(state.size());
  for (const PhaseRow& row : phases()) {
    const auto said = page.find(row.name);
    if (said == page.end()) continue;
    for (ModelSpec spec : test::examples_of(row)) {
      check_phase(spec);
      const auto phase = bake_phase(spec, state);
      Known of;
      for (const double c : {-0.9, -0.2, 0.3, 0.9}) {
        const auto p = phase->polarised(c, b);
        of.add(p.unknown, std::fabs(b[0].b));
      }
      EXPECT_NE(said->second.find(of.name()), std::string::npos) << row.name << ' ' << of.name();
    }
  }
}

// Scattering matrices: of molecules in closed form (depolarisation 0.0279: degree 0.9457146 at 90 deg), of tables what
// they say, and what cannot be is refused where it stands.
TEST(Mueller, PhaseFunctionsScatterAsTheirMatricesSay) {
  const SpectralState state = test::test_state(1);
  std::vector<PlaneBlocks> b(state.size());
  const auto made = [&](ModelSpec spec) {
    check_phase(spec);
    return bake_phase(spec, state);
  };
  const auto air = made({"rayleigh", {{"depolarisation", 0.0279}}, {}, {}, nullptr});
  EXPECT_EQ(air->polarised(0, b).unknown, 0);
  EXPECT_NEAR(b[0].b, -0.9457146, 1e-7);
  for (const double c : {-1.0, -0.3, 0.0, 0.7, 1.0}) {
    air->polarised(c, b);
    EXPECT_GT(least_coherency(b[0].matrix()), -1e-12) << c;
  }
  EXPECT_NEAR(b[0].c, b[0].a2, 1e-12) << "straight on";
  EXPECT_EQ(made({"hg", {}, {{"g", Curve::constant(0.5)}}, {}, nullptr})->polarised(0.2, b).unknown, 1);
  const auto table = [&](const std::string& matrix) {
    return made({"tabulated", {}, {}, {{"table", "0 2, 90 1, 180 2"}, {"matrix", matrix}}, nullptr});
  };
  EXPECT_EQ(table("0 0 1 1 0 1, 90 -0.8 0.9 0 0.1 0, 180 0 0.9 -0.9 0 -0.8")->polarised(0, b).unknown, 0);
  EXPECT_NEAR(b[0].b, -0.8, 1e-12);
  EXPECT_NEAR(b[0].d, 0.1, 1e-12);
  for (const char* wrong : {"0 0 1 1 0 1, 90 -0.8 0.9", "0 0 1 1 0 1", "10 0 1 1 0 1, 180 0 1 -1 0 -1",
                            "0 0 1 1 0 1, 180 0 1 -1 0 1", "0 0 1 1 0 1, 90 -1.2 1 0 0 0, 180 0 1 -1 0 -1", "0 a"})
    EXPECT_THROW(table(wrong), Error) << wrong;
}

}  // namespace
}  // namespace suite::mueller_test
