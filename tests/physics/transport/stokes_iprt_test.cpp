// Polarisation of layers against the tables of the IPRT intercomparison.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>

#include "formats/reptran/netcdf3.h"
#include "math/sampling.h"
#include "tests/support/stokes_kit.h"

namespace suite::test::stokes_iprt_test {
namespace {

// Standard errors of 8 groups: Student's t of 7 degrees is beyond 12 with a probability of 6e-6; its square has a mean
// of 1.4 and a standard deviation of 2.8.
constexpr double kSignificant = 12, kMeanSquare = 1.4, kSpread = 2.8;

// Cases of the IPRT intercomparison (C. Emde et al., JQSRT 164, 2015) as PSTAR computes them: one layer under a
// collimated sun of irradiance 1. Azimuths from x towards y; view zenith and azimuth of the direction looked along. The
// tables are not part of the project.
struct IprtRow {
  double depolarisation, altitude, sza, saa, vza, vaa;
  Stokes S;
};
std::vector<IprtRow> iprt(const std::string& file) {
  std::vector<IprtRow> rows;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    IprtRow r{};
    std::istringstream(line) >> r.depolarisation >> r.altitude >> r.sza >> r.saa >> r.vza >> r.vaa >> r.S[0] >>
        r.S[1] >> r.S[2] >> r.S[3];
    // Straight up and down the meridian is that of azimuth 0.
    if (std::fabs(std::sin(r.vza * kDegree)) > 1e-9 || r.vaa == 0) rows.push_back(r);
  }
  return rows;
}
bool long_run() { return std::getenv("SUITE_LONG") != nullptr; }
const char* iprt_folder() { return std::getenv("SUITE_POLARISATION_DATA"); }

struct IprtCase {
  double depth = 0.5, albedo = 1, ground = 0;  // single-scattering albedo; reflectance
  int long_paths = 19;                         // power of two
  bool resolved = true;                        // to 0.3 % in the long run
  std::function<ModelSpec(const IprtRow&)> phase;
};
// V over that of the table, by least squares, with its error.
struct Slope {
  double value, error;
};
Slope compare(const std::vector<IprtRow>& rows, const IprtCase& c) {
  double product = 0, weight = 0, squares = 0, numbers = 0;
  for (size_t first = 0; first < rows.size();) {
    const IprtRow& f = rows[first];
    size_t end = first;
    while (end < rows.size() && rows[end].depolarisation == f.depolarisation && rows[end].sza == f.sza) ++end;
    auto scene = std::make_shared<Scene>(*slab_scene(
        medium(Curve::constant(c.depth * (1 - c.albedo)), Curve::constant(c.depth * c.albedo), c.phase(f)), 1));
    if (c.ground > 0) {
      scene->materials.push_back(material("ground", lambert(c.ground)));
      place(*scene, PrimitiveKind::plane, {0, 0}, 2, translation({0, 0, 1e-6}));
      check_scene(*scene, "slab over ground");
    }
    SourceSpecs sources;
    sources.add(SunSpec{{dir_from_angles(f.sza * kDegree, f.saa * kDegree), 0, Curve::constant(1)}});
    std::vector<Ray> rays;
    for (size_t i = first; i < end; ++i)
      rays.push_back({{0, 0,
                       rows[i].altitude > 0.5 ? 1.5
                       : c.ground > 0         ? 1e-5
                                              : -0.5},
                      dir_from_angles(rows[i].vza * kDegree, rows[i].vaa * kDegree),
                      0});
    const auto seen = see_stokes(scene, sources, rays, 1u << (long_run() ? c.long_paths : 12));
    for (size_t i = first; i < end; ++i) {
      const StokesSeen& s = seen[i - first];
      for (size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(s.S[k], rows[i].S[k], 2e-7 + kSignificant * s.error[k]) << "IQU"[k] << " of row " << i;
        if (s.error[k] > 0) {
          squares += std::pow((s.S[k] - rows[i].S[k]) / s.error[k], 2);
          ++numbers;
        }
        if (!long_run() || !c.resolved) continue;
        EXPECT_NEAR(s.S[k], rows[i].S[k], 0.003 * rows[i].S[0]) << "IQU"[k] << " of row " << i;
      }
      if (!(s.error[3] > 0)) continue;
      product += s.S[3] * rows[i].S[3] / (s.error[3] * s.error[3]);
      weight += rows[i].S[3] * rows[i].S[3] / (s.error[3] * s.error[3]);
    }
    first = end;
  }
  if (c.resolved) {
    EXPECT_LT(squares / numbers, kMeanSquare + 5 * kSpread / std::sqrt(numbers)) << "all together";
  }
  return {weight > 0 ? product / weight : 0, weight > 0 ? 1 / std::sqrt(weight) : INFINITY};
}

TEST(Stokes, RayleighLayersAgreeWithPstar) {
  if (!iprt_folder()) GTEST_SKIP() << "SUITE_POLARISATION_DATA does not name the folder with iprt/";
  const auto phase = [](const IprtRow& r) {
    return ModelSpec{"rayleigh", {{"depolarisation", r.depolarisation}}, {}, {}, nullptr};
  };
  const auto a1 = iprt(std::string(iprt_folder()) + "/iprt/a1_rayleigh.txt"),
             a2 = iprt(std::string(iprt_folder()) + "/iprt/a2_lambert.txt");
  ASSERT_GT(a1.size(), 60u);
  ASSERT_GT(a2.size(), 10u);
  compare(a1, {0.5, 1, 0, 21, true, phase});
  compare(a2, {0.1, 1, 0.3, 21, true, phase});
}
// Prolate spheroids of mopsmap: six elements, and light that turns. Of the rows off the principal plane V is a hundred
// thousandth of I: all of them together show its sign and size. Forward peaks leave I at some 1 % at 2^19 paths.
TEST(Stokes, ALayerOfSpheroidsAgreesWithPstar) {
  if (!iprt_folder()) GTEST_SKIP() << "SUITE_POLARISATION_DATA does not name the folder with iprt/";
  if (!long_run()) GTEST_SKIP() << "in the long run";
  const NetCdf3 file(std::string(iprt_folder()) + "/sizedistr_spheroid.cdf");
  constexpr size_t n = 1801;
  const auto theta = file.numbers("theta", {1, 1, 6, n}), P = file.numbers("phase", {1, 1, 6, n});
  const double albedo = file.numbers("ssa", {1, 1})[0];
  std::string table, matrix;
  for (size_t i = 0; i < n; ++i) {
    // Rows: P11, P12, P33, P34, P22, P44, all of one grid of angles.
    const size_t at = theta[0] < theta[n - 1] ? i : n - 1 - i;
    const auto element = [&](size_t row) { return P[row * n + at] / P[at]; };
    table += strf("%.9g %.9g, ", theta[at], P[at]);
    matrix +=
        strf("%.9g %.9g %.9g %.9g %.9g %.9g, ", theta[at], element(1), element(4), element(2), element(3), element(5));
  }
  const auto a4 = iprt(std::string(iprt_folder()) + "/iprt/a4_spheroid.txt");
  ASSERT_GT(a4.size(), 20u);
  const Slope V = compare(a4, {0.2, albedo, 0, 19, false, [&](const IprtRow&) {
                                 return ModelSpec{"tabulated", {}, {}, {{"table", table}, {"matrix", matrix}}, nullptr};
                               }});
  EXPECT_LT(V.error, 0.05);
  EXPECT_NEAR(V.value, 1, kSignificant * V.error);
}

// V. Natraj, K. Li, Y. Yung, ApJ 691, 2009: layers of molecules over Lambert floors, I, Q and U times pi. 40 of the
// 14,000 rows. phi: from the sun's azimuth to that of the light; the signs of Q and U are the other ones there. The
// table is not part of the project.
TEST(Stokes, RowsOfNatrajAgreeWithPaths) {
  if (!iprt_folder()) GTEST_SKIP() << "SUITE_POLARISATION_DATA does not name the folder with natraj2009_tau.csv";
  struct Row {
    IprtRow row;
    double depth, ground;
  };
  std::vector<Row> rows;
  std::ifstream in(std::string(iprt_folder()) + "/natraj2009_tau.csv");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("UP") && !line.starts_with("DN")) continue;
    const bool up = line[0] == 'U';
    std::replace(line.begin(), line.end(), ',', ' ');
    double tau, ground, mu0, mu, phi, I, Q, U;
    std::istringstream(line.substr(2)) >> tau >> ground >> mu0 >> mu >> phi >> I >> Q >> U;
    if (mu > 0.999) continue;  // no meridian
    const double from_zenith = std::acos(mu) / kDegree;
    rows.push_back({{0,
                     up ? 1.0 : 0.0,
                     std::acos(mu0) / kDegree,
                     0,
                     up ? 180 - from_zenith : from_zenith,
                     -phi,
                     {I / kPi, -Q / kPi, -U / kPi, 0}},
                    tau,
                    ground});
  }
  ASSERT_GT(rows.size(), 13000u);
  Pcg32 random(2009);
  const auto molecules = [](const IprtRow&) { return ModelSpec{"rayleigh", {{"depolarisation", 0}}, {}, {}, nullptr}; };
  for (int n = 0; n < (long_run() ? 40 : 4); ++n) {
    const Row& r =
        rows[std::min(rows.size() - 1, static_cast<size_t>(random.uniform() * static_cast<double>(rows.size())))];
    SCOPED_TRACE(
        strf("depth %g, ground %g, sun %g, view %g, %g deg", r.depth, r.ground, r.row.sza, r.row.vza, r.row.vaa));
    compare({r.row}, {r.depth, 1, r.ground, 17, false, molecules});
  }
}

}  // namespace
}  // namespace suite::test::stokes_iprt_test
