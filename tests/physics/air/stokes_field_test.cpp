// The polarised field of plane air: closed forms, conservation, the scalar field, published tables.
#include "air/stokes_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "formats/reptran/netcdf3.h"

namespace suite::stokes_field_test {
namespace {

using Way = StokesField::Way;
using Light = StokesField::Light;

// Never quite upright: there the azimuth says which meridian is meant.
Dir direction(double mu, double phi) {
  const double sine = std::max(1e-6, std::sqrt(1 - mu * mu));
  return {sine * std::cos(phi), sine * std::sin(phi), mu};
}

// A matrix that has all elements, of light that goes forward.
GreekMatrix hazy() {
  std::vector<double> cosines;
  std::vector<PlaneBlocks> blocks;
  for (int i = 0; i <= 400; ++i) {
    const double c = -1 + i / 200.0, forward = 1 / std::pow(1.25 - c, 1.5);
    cosines.push_back(c);
    const double across = 1 - c * c;
    blocks.push_back(PlaneBlocks{1, -0.3 * across, 0.8 * c, 0.2 * across, 0.8 - 0.1 * (1 - c), 0.7 * c} * forward);
  }
  blocks.back().a2 = blocks.back().c;  // forward and backward as symmetry has it
  blocks.front().a2 = -blocks.front().c;
  return GreekMatrix::tabulated(cosines, blocks, 12);
}

// Sum of the modes against the matrix between meridian frames, all columns.
TEST(StokesFunctions, ModesSumToTheMatrix) {
  for (const GreekMatrix& matrix : {GreekMatrix::rayleigh(0.0279), hazy()})
    for (const auto& [out, in, phi] : {std::array{0.3, -0.6, 0.7}, std::array{-0.9, -0.2, 2.5},
                                       std::array{0.5, 0.8, 4.0}, std::array{-0.4, 0.95, 5.5}}) {
      const Dir k_out = direction(out, phi), k_in = direction(in, 0);
      const Mueller whole = ScatteringPlane(k_out, -k_in).matrix(matrix.at(dot(k_out, k_in)));
      double sum[4][4] = {};
      for (int m = 0; m < static_cast<int>(matrix.degrees.size()); ++m)
        for (int s = 0; s < 4; ++s) {
          const StokesMode x = scattered(matrix, StokesFunctions(m, out, 12), StokesFunctions(m, in, 12),
                                         {double(s == 0), double(s == 1), double(s == 2), double(s == 3)});
          const double c = (m == 0 ? 1 : 2) * std::cos(m * phi), t = (m == 0 ? 1 : 2) * std::sin(m * phi);
          sum[0][s] += x.i * (s >= 2 ? -t : c), sum[1][s] += x.q * (s >= 2 ? -t : c);
          sum[2][s] += x.u * (s >= 2 ? c : t), sum[3][s] += x.v * (s >= 2 ? c : t);
        }
      for (int r = 0; r < 4; ++r)
        for (int s = 0; s < 4; ++s) EXPECT_NEAR(sum[r][s], whole(r, s), 1e-12) << r << s << " at " << out << ' ' << in;
    }
}

// The series gives a table back; molecules' coefficients are those of their matrix.
TEST(GreekMatrix, TabulatesMolecules) {
  const GreekMatrix exact = GreekMatrix::rayleigh(0.0279);
  std::vector<double> cosines;
  std::vector<PlaneBlocks> blocks;
  for (int i = 0; i <= 2000; ++i) {
    cosines.push_back(-1 + i / 1000.0);
    blocks.push_back(exact.at(cosines.back()) * 3.0);
  }
  const GreekMatrix again = GreekMatrix::tabulated(cosines, blocks, 5);
  for (size_t l = 0; l < 5; ++l) {
    const GreekMatrix::Degree want = l < 3 ? exact.degrees[l] : GreekMatrix::Degree{}, &got = again.degrees[l];
    for (const auto& [a, b] : {std::pair{got.a1, want.a1},
                               {got.a2, want.a2},
                               {got.a3, want.a3},
                               {got.a4, want.a4},
                               {got.b1, want.b1},
                               {got.b2, want.b2}})
      EXPECT_NEAR(a, b, 2e-6) << "degree " << l;
  }
  const PlaneBlocks side = exact.at(0);  // the page of the molecules: Hansen & Travis 1974, degree of polarisation
  EXPECT_NEAR(-side.b / side.a, 0.9457146, 1e-7);
}

struct Slab {
  GreekMatrix matrix = GreekMatrix::rayleigh(0);
  std::vector<StokesAirLayer> layers;
  StokesProblem problem;
  Slab(double depth, double albedo, double cosine, double ground, GreekMatrix of = GreekMatrix::rayleigh(0),
       int parts = 1)
      : matrix(std::move(of)) {
    for (int i = 0; i < parts; ++i) layers.push_back({depth / parts, albedo, &matrix});
    problem.layers = layers;
    problem.beam.irradiance = 1, problem.beam.cosine = cosine;
    problem.ground_albedo = ground;
  }
};

// So dark that nothing is scattered twice: I, Q, U of the closed form, up and down, and between layers.
TEST(StokesField, ScattersOnceInClosedForm) {
  constexpr double kDepth = 0.3, kSun = 0.5, kDark = 1e-7;
  const Slab slab(kDepth, kDark, kSun, 0, GreekMatrix::rayleigh(0.0279), 3);
  StokesField field(Light::polarised, 8, {0.2, 0.9});
  field.solve(slab.problem);
  for (const double phi : {0.0, 1.0, 4.0})
    for (size_t v = 0; v < 2; ++v) {
      const double mu = v == 0 ? 0.2 : 0.9, top = 0.1, rest = kDepth - top;  // seen from the bottom of the first layer
      const Dir in = direction(-kSun, 0);
      const auto once = [&](double c) {
        const Dir out = direction(c, phi);
        return scattered_once(slab.matrix.at(dot(out, in)) * (kDark / (4 * kPi)), out, in);
      };
      const double above = (std::exp(-top / mu) - std::exp(-top / kSun)) / (mu / kSun - 1),
                   below = std::exp(-top / kSun) * (1 - std::exp(-rest * (1 / mu + 1 / kSun))) / (1 + mu / kSun);
      const Stokes up = field.radiance(1, v, Way::up, phi, {}), down = field.radiance(1, v, Way::down, phi, {});
      for (size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(up[k] / kDark, once(mu)[k] * below / kDark, 2e-7) << k;
        EXPECT_NEAR(down[k] / kDark, once(-mu)[k] * above / kDark, 2e-7) << k;
      }
    }
}

// Light that molecules do not absorb goes out or into the ground.
TEST(StokesField, ConservesTheFluxOfMolecules) {
  for (const double depth : {0.01, 0.5, 20.0}) {
    const Slab slab(depth, 1, 0.6, 0.3, GreekMatrix::rayleigh(0.0279), 4);
    StokesField field(Light::polarised, 16);
    field.solve(slab.problem);
    const double net = 0.6 - field.fluxes(0).up;
    for (int level = 0; level <= 4; ++level) {
      const DiffuseFluxes f = field.fluxes(level);
      EXPECT_NEAR(f.direct + f.down - f.up, net, 1e-9) << depth << " level " << level;
    }
    const DiffuseFluxes at_ground = field.fluxes(4);
    EXPECT_NEAR(at_ground.up, 0.3 * (at_ground.down + at_ground.direct), 1e-12);
  }
}

// Where nothing is polarised it is the scalar field (discrete_ordinates.h): modes, secants, ground.
TEST(StokesField, IsTheScalarFieldWithoutPolarisation) {
  const std::vector<double> moments = [] {
    std::vector<double> chi;
    for (int l = 0; l <= 16; ++l) chi.push_back(std::pow(0.7, l));
    return chi;
  }();
  const double secants[] = {1.9, 2.0, 2.2};
  std::vector<GreekMatrix> matrices(3, GreekMatrix::depolarising(moments));
  std::vector<StokesAirLayer> layers{{0.1, 0.99, &matrices[0]}, {1.5, 0.9, &matrices[1]}, {1e-6, 0.9, &matrices[2]}};
  std::vector<DiffuseLayer> scalar_layers;
  for (const StokesAirLayer& l : layers) scalar_layers.push_back({l.depth, l.albedo, moments});
  StokesProblem problem;
  problem.layers = layers;
  problem.beam = {1, 0.5, secants, {}};
  problem.ground_albedo = 0.4;
  DiffuseProblem scalar;
  scalar.layers = scalar_layers;
  scalar.beam = problem.beam, scalar.ground_albedo = 0.4, scalar.azimuth_tolerance = 1e-9;
  DiscreteOrdinates ordinates(16);
  ordinates.solve(scalar);
  for (const Light light : {Light::intensity, Light::polarised}) {
    StokesField field(light, 16, {0.4});
    field.solve(problem);
    for (int level = 0; level < 3; ++level) {
      EXPECT_NEAR(field.fluxes(level).up, ordinates.fluxes({level, 0}).up, 1e-7);
      const DiffuseFluxes f = field.fluxes(level), g = ordinates.fluxes({level, 0});
      EXPECT_NEAR(f.down + f.direct, g.down + g.direct, 1e-7);  // their parts differ by the forward peak
      for (const double phi : {0.2, 2.0}) {
        const std::vector<double> phase(3, 1 / (4 * kPi));  // the same at all angles, for both
        const std::vector<Stokes> single(3, Stokes{1 / (4 * kPi), 0, 0, 0});
        for (const Way way : {Way::up, Way::down})
          EXPECT_NEAR(field.radiance(level, 0, way, phi, single)[0],
                      ordinates.radiance({level, 0}, way == Way::up ? 0.4 : -0.4, phi, phase), 1e-6);
        for (int m = 0; m < 4; ++m) {
          std::vector<double> air(static_cast<size_t>(ordinates.orders())), on_ground(1);
          const double mu[] = {0.25};
          ordinates.sources({level, 0}, SourceAngles(16, mu), air, on_ground);
          const double want = air[static_cast<size_t>(m)] + (m == 0 ? ordinates.ground_radiance() * on_ground[0] : 0);
          EXPECT_NEAR(field.source(level, StokesField::End::top, m, StokesFunctions(m, 0.25, 16)).i, want, 1e-6) << m;
        }
      }
    }
  }
}

// V. Natraj, K.-F. Li, Y. L. Yung, "Rayleigh scattering in planetary atmospheres: corrected tables through accurate
// computation of X and Y functions", Astrophys. J. 691, 2009: I, Q, U over the beam's irradiance / pi. Q and U have the
// other sign there, and phi runs the other way round.
struct NatrajRow {
  bool up = false;
  double tau = 0, albedo = 0, mu0 = 0, mu = 0, phi = 0;
  Stokes S{};
};
void raise(double& worst, double difference) {
  if (!(std::fabs(difference) <= worst)) worst = std::fabs(difference);  // NaN, too
}
void compare(const std::vector<NatrajRow>& rows, double b1_sign, double& worst) {
  std::map<std::array<double, 4>, std::vector<const NatrajRow*>> by;
  for (const NatrajRow& r : rows) by[{r.tau, r.albedo, r.mu0, r.mu}].push_back(&r);
  GreekMatrix molecules = GreekMatrix::rayleigh(0);
  molecules.degrees[2].b1 *= b1_sign;
  for (const auto& [key, of] : by) {
    const Slab slab(key[0], 1, key[2], key[1], molecules);
    StokesField field(Light::polarised, 16, {key[3]});
    field.solve(slab.problem);
    for (const NatrajRow* r : of) {
      const Stokes got = field.radiance(r->up ? 0 : 1, 0, r->up ? Way::up : Way::down, -r->phi * kDegree, {});
      for (size_t k = 0; k < 3; ++k) raise(worst, (got[k] * kPi - (k == 0 ? 1 : -1) * r->S[k]) / r->S[0]);
    }
  }
}
std::vector<NatrajRow> natraj(std::istream& in) {
  std::vector<NatrajRow> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("UP", 0) != 0 && line.rfind("DN", 0) != 0) continue;
    NatrajRow r;
    r.up = line[0] == 'U';
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream(line.substr(2)) >> r.tau >> r.albedo >> r.mu0 >> r.mu >> r.phi >> r.S[0] >> r.S[1] >> r.S[2];
    rows.push_back(r);
  }
  return rows;
}

constexpr double kTable = 1e-3;  // of I

TEST(StokesField, AgreesWithTablesOfMolecules) {
  std::istringstream some(R"(DN,0.1,0.25,0.2,0.98,0,0.02126896,0.01305842,0
DN,0.1,0.8,0.6,0.92,90,0.051711079,-0.01149979,0.0076114102
DN,0.25,0,0.92,0.72,180,0.076328523,0.050284121,0
DN,0.25,0.8,0.1,0.64,60,0.04492905,-0.01997434,-0.01009604
DN,0.5,0,0.4,0.4,150,0.17282575,0.0075804899,0.061479378
DN,0.5,0.25,0.8,0.32,30,0.35338548,0.02213837,0.056156021
UP,0.1,0.25,0.2,0.16,0,0.18803044,0.0023968599,0
UP,0.1,0.8,0.6,0.06,90,0.45345169,-0.05114089,0.15584406
UP,0.25,0,0.8,1,180,0.078916468,0.01540869,0
UP,0.5,0,0.2,0.92,150,0.068434387,0.0084753605,-0.02854377
UP,0.5,0.25,0.6,0.84,30,0.19600019,0.05198231,0.05971615
UP,0.5,0.8,0.92,0.64,120,0.75167674,0.02236983,0.048267212
)");
  const std::vector<NatrajRow> rows = natraj(some);
  ASSERT_EQ(rows.size(), 12u);
  double worst = 0, wrong = 0;
  compare(rows, 1, worst);
  compare(rows, -1, wrong);
  EXPECT_LT(worst, kTable);
  EXPECT_GT(wrong, 100 * kTable);  // a sign of b1
}

// Light scattered once by a thin layer, sun at 60 degrees, looked at straight down (closed form, depolarisation 0.0279;
// Hansen & Travis 1974): I/E0 7.369816e-4 for each unit of the albedo, degree 0.573657. An albedo of 1e-5 leaves out
// all further orders.
TEST(StokesField, AThinLayerScattersOnce) {
  constexpr double kAlbedo = 1e-5;
  const GreekMatrix molecules = GreekMatrix::rayleigh(0.0279);
  const Slab slab(0.01, kAlbedo, 0.5, 0, molecules);
  StokesField field(Light::polarised, 16, {1.0});
  field.solve(slab.problem);
  const Stokes got = field.radiance(0, 0, Way::up, 0, {});
  EXPECT_NEAR(got[0], kAlbedo * 7.369816e-4, 1e-5 * kAlbedo * 7.369816e-4);
  EXPECT_NEAR(std::hypot(got[1], got[2]) / got[0], 0.573657, 1e-5);
}

const char* folder() { return std::getenv("SUITE_POLARISATION_DATA"); }

TEST(StokesField, AgreesWithAllTablesOfMolecules) {
  if (!folder()) GTEST_SKIP() << "SUITE_POLARISATION_DATA does not name the folder with natraj2009_tau.csv";
  std::ifstream file(std::string(folder()) + "/natraj2009_tau.csv");
  const std::vector<NatrajRow> rows = natraj(file);
  ASSERT_GT(rows.size(), 14000u);
  double worst = 0;
  compare(rows, 1, worst);
  EXPECT_LT(worst, kTable);
  RecordProperty("worst", std::to_string(worst));
}

// Cases of the IPRT intercomparison (C. Emde et al., JQSRT 164, 2015) as PSTAR computes them (transport/stokes_iprt has
// the columns). The tables are not part of the project.
struct IprtRow {
  double depolarisation, altitude, sza, saa, vza, vaa;
  Stokes S;
};
// The largest differences: of I, Q and U over I, and of V, where it is solved for, over the table's largest.
struct PstarErrors {
  double linear = 0, circular = 0;
};
PstarErrors against_pstar(const std::string& file, double depth, double albedo, double ground, int streams,
                          const std::function<GreekMatrix(const IprtRow&)>& matrix,
                          const std::function<PlaneBlocks(double cosine)>& whole, Light light = Light::polarised) {
  std::ifstream in(std::string(folder()) + "/iprt/" + file);
  double worst = 0, worst_v = 0, most_v = 0;
  size_t count = 0;
  std::optional<StokesField> field;
  std::array<double, 3> solved{};
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    IprtRow r{};
    std::istringstream(line) >> r.depolarisation >> r.altitude >> r.sza >> r.saa >> r.vza >> r.vaa >> r.S[0] >>
        r.S[1] >> r.S[2] >> r.S[3];
    const double mu = std::fabs(std::cos(r.vza * kDegree)), mu0 = std::cos(r.sza * kDegree);
    if (const std::array now{r.depolarisation, mu0, mu}; now != solved) {  // rows of one ring stand together
      const Slab slab(depth, albedo, mu0, ground, matrix(r));
      field.emplace(light, streams, std::vector{std::max(mu, 1e-4)});
      field->solve(slab.problem);
      solved = now;
    }
    const bool up = r.altitude > 0.5;
    // Light travels against the view, and from the sun.
    const double phi = (r.vaa - r.saa) * kDegree;
    const Dir out = direction(up ? mu : -mu, phi), sun = direction(-mu0, 0);
    std::vector<Stokes> single;
    if (whole) single.push_back(scattered_once(whole(dot(out, sun)) * (1 / (4 * kPi)), out, sun));
    const Stokes got = field->radiance(up ? 0 : 1, 0, up ? Way::up : Way::down, phi, single);
    for (size_t k = 0; k < 3; ++k) raise(worst, (got[k] - r.S[k]) / r.S[0]);
    raise(worst_v, got[3] - r.S[3]), raise(most_v, r.S[3]);
    ++count;
  }
  EXPECT_GT(count, 10u) << file;
  return {worst, most_v > 0 ? worst_v / most_v : 0};
}

TEST(StokesField, AgreesWithPstar) {
  if (!folder()) GTEST_SKIP() << "SUITE_POLARISATION_DATA does not name the folder with iprt/";
  const auto molecules = [](const IprtRow& r) { return GreekMatrix::rayleigh(r.depolarisation); };
  EXPECT_LT(against_pstar("a1_rayleigh.txt", 0.5, 1, 0, 16, molecules, {}).linear, 0.003);
  EXPECT_LT(against_pstar("a2_lambert.txt", 0.1, 1, 0.3, 16, molecules, {}).linear, 0.003);
}

// Prolate spheroids of mopsmap, which make V as well.
TEST(StokesField, AgreesWithPstarAboutSpheroids) {
  if (!folder()) GTEST_SKIP() << "SUITE_POLARISATION_DATA does not name the folder with iprt/";
  const NetCdf3 file(std::string(folder()) + "/sizedistr_spheroid.cdf");
  constexpr size_t n = 1801;
  const auto theta = file.numbers("theta", {1, 1, 6, n}), P = file.numbers("phase", {1, 1, 6, n});
  const double albedo = file.numbers("ssa", {1, 1})[0];
  std::vector<double> cosines;
  std::vector<PlaneBlocks> blocks;
  for (size_t i = 0; i < n; ++i) {
    const size_t at = theta[0] > theta[n - 1] ? i : n - 1 - i;
    cosines.push_back(std::cos(theta[at] * kDegree));
    // Rows: P11, P12, P33, P34, P22, P44.
    blocks.push_back({P[at], P[n + at], P[2 * n + at], P[3 * n + at], P[4 * n + at], P[5 * n + at]});
  }
  cosines.front() = -1, cosines.back() = 1;
  const GreekMatrix matrix = GreekMatrix::tabulated(cosines, blocks, 40);
  const double mean = [&] {
    double sum = 0;
    for (size_t i = 0; i + 1 < n; ++i) sum += (cosines[i + 1] - cosines[i]) * (blocks[i].a + blocks[i + 1].a) / 4;
    return sum;
  }();
  const auto whole = [&](double c) {
    const size_t i =
        std::min<size_t>(n - 2, static_cast<size_t>(std::max<std::ptrdiff_t>(
                                    0, std::upper_bound(cosines.begin(), cosines.end(), c) - cosines.begin() - 1)));
    const double x = std::clamp((c - cosines[i]) / (cosines[i + 1] - cosines[i]), 0.0, 1.0);
    return (blocks[i] * (1 - x) + blocks[i + 1] * x) * (1 / mean);
  };
  // Truncation of the forward peak makes the most of the error: 16 streams have 0.8 %, 32 have 0.5 %.
  const auto error = [&](int streams, Light light, const GreekMatrix& of) {
    return against_pstar(
        "a4_spheroid.txt", 0.2, albedo, 0, streams, [&](const IprtRow&) { return of; }, whole, light);
  };
  EXPECT_LT(error(36, Light::polarised, matrix).linear, 0.003);
  EXPECT_LT(error(16, Light::polarised, matrix).linear, 0.01);
  // V is scattered twice at least, so that truncation acts on all of it: it wants more streams.
  for (const auto& [streams, linear, circular] :
       {std::tuple{8, 0.05, 0.6}, {16, 0.01, 0.2}, {24, 0.007, 0.08}, {28, 0.003, 0.022}}) {
    const PstarErrors all = error(streams, Light::circular, matrix);
    std::printf("%d streams with V: I, Q and U within %.4f of I, V within %.4f of its largest\n", streams, all.linear,
                all.circular);
    EXPECT_LT(all.linear, linear) << streams;
    EXPECT_LT(all.circular, circular) << streams;
  }
  // Control: without V, and with retardance of the other sign.
  EXPECT_GT(error(24, Light::polarised, matrix).circular, 0.9);
  GreekMatrix flipped = matrix;
  for (GreekMatrix::Degree& d : flipped.degrees) d.b2 *= -1;
  EXPECT_GT(error(24, Light::circular, flipped).circular, 0.9);
}

}  // namespace
}  // namespace suite::stokes_field_test
