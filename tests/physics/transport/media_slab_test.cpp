// Fluxes of plane-parallel scattering slabs against DISORT's published test problems 1-3 (K. Stamnes et al.,
// "Numerically stable algorithm for discrete-ordinate-method radiative transfer", Appl. Opt. 27, 1988), as a body
// between two surfaces and as a voxel grid.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/support/media_kit.h"

namespace suite::test::media_slab_test {
namespace {

struct Reference {
  double up = 0, down = 0, bottom = 0;
};

// Upward flux at the top and diffuse downward flux at the bottom, per problem.
std::map<std::string, Reference> references() {
  std::ifstream file(SUITE_TEST_DATA "/slab/disort_tests_1_2_3.csv");
  std::map<std::string, Reference> all;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream row(line);
    std::string name;
    double tau, up, down, direct;
    row >> name >> tau >> up >> down >> direct;
    if (tau == 0)
      all[name].up = up;
    else
      all[name].down = down, all[name].bottom = tau;
  }
  return all;
}

struct Case {
  std::string name;
  double albedo, mu0, beam;
  ModelSpec phase;
  // Powers of two of the paths of the long run, up and down: what resolves 0.5 % of both fluxes (1f down: 1 %).
  int up = 18, down = 18;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
std::vector<Case> cases() {
  const ModelSpec rayleigh{"rayleigh", {}, {}, {}, nullptr};
  const double dim = kPi / 0.1;
  return {{"1a", 0.2, 0.1, dim, hg(0), 23, 23},         {"1b", 1, 0.1, dim, hg(0), 21, 21},
          {"1c", 0.99, 0.1, dim, hg(0), 21, 21},        {"1d", 0.2, 0.1, dim, hg(0), 21, 14},
          {"1e", 1, 0.1, dim, hg(0), 18, 25},           {"1f", 0.99, 0.1, dim, hg(0), 18, 22},
          {"2a", 0.5, 0.080442, kPi, rayleigh, 20, 20}, {"2b", 1, 0.080442, kPi, rayleigh, 19, 19},
          {"2c", 0.5, 0.080442, kPi, rayleigh, 19, 24}, {"2d", 1, 0.080442, kPi, rayleigh, 18, 22},
          {"3a", 1, 1, kPi, hg(0.75), 23, 19},          {"3b", 1, 1, kPi, hg(0.75), 20, 20}};
}

// Both fluxes with their standard errors.
struct Fluxes {
  double up, down, up_error, down_error;
};
Fluxes fluxes(const std::shared_ptr<const Scene>& scene, const Case& c, double thickness, uint32_t paths) {
  SourceSpecs sources;
  sources.add(SunSpec{{{std::sqrt(1 - c.mu0 * c.mu0), 0, c.mu0}, 0, Curve::constant(c.beam)}});
  const std::vector<Ray> looks{{{0, 0, thickness + 0.5}, {0, 0, -1}, 0}, {{0, 0, -0.5}, {0, 0, 1}, 0}};
  PipelineOptions options;
  options.seed = 7;
  options.roulette_after = 30;
  const auto run = render(scene, sources, std::make_unique<FluxSensor>(looks, one_band(), paths), options);
  EXPECT_EQ(run.report.statistics.failures, 0u);
  const auto& r = run.result;
  return {kPi * r.radiance[0], kPi * r.radiance[1], kPi * r.standard_error[0], kPi * r.standard_error[1]};
}

// The run under the label `long` sets SUITE_LONG and resolves all of a body's fluxes to 0.5 % but one. The default run
// takes 2^14 paths a flux, which know what comes up to 0.1 to 3 % (deviations of 4 of these are seen, p = 6e-5), and
// more where that resolves a flux. A hundredth of albedo is seen by them (DisortSlabControl).
bool long_run() { return std::getenv("SUITE_LONG") != nullptr; }

constexpr double kRounding = 2e-5;  // of the table, relative
constexpr double kBound = 5e-3;     // what every flux has to be within

std::array<int, 2> powers_of(const Case& c) {
  if (long_run()) return {c.up, c.down};
  if (c.name == "1f") return {15, 14};
  if (c.name == "2d") return {16, 14};
  if (c.name == "3a") return {14, 16};
  return {14, 14};
}
// Deep slabs let so little through that what comes down is known to some ten per cent only, and take most of the time.
bool deep(double tau) { return tau > 20; }

struct Flux {
  double value, error;
};

// Paths that run from the sun's side: looked at along the beam under a uniform sky of radiance 1, a slab shows the
// share of the beam that it sends back, and from below what it lets through (Helmholtz: the albedo of a slab for a beam
// is its reflectance under diffuse light seen along the beam). Nothing but flights, scattering and absorption has a
// part in it, so that its errors and those of the explicit sun are strangers to each other; grazing beams cost nothing.
std::array<Flux, 2> fluxes_by_reciprocity(const std::shared_ptr<const Scene>& scene, const Case& c, double tau,
                                          double thickness, std::array<int, 2> powers) {
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  PipelineOptions options;
  options.seed = 11;
  options.roulette_after = 100000;
  options.max_scatterings = 1000000;
  const double sine = std::sqrt(1 - c.mu0 * c.mu0);
  std::array<Flux, 2> all;
  for (const size_t down : {0u, 1u}) {
    const Ray look =
        down ? Ray{{0, 0, -0.5}, {-sine, 0, c.mu0}, 0} : Ray{{0, 0, thickness + 0.5}, {sine, 0, -c.mu0}, 0};
    const auto run =
        render(scene, sources,
               std::make_unique<RaySensor>(std::vector<Ray>(16, look), one_band(), 1u << (powers[down] - 4)), options);
    EXPECT_EQ(run.report.statistics.failures, 0u);
    EXPECT_EQ(run.report.statistics.truncated, 0) << "paths were cut";
    double mean = 0, square = 0;
    for (size_t i = 0; i < 16; ++i) {
      mean += run.result.radiance[i] / 16;
      square += run.result.standard_error[i] * run.result.standard_error[i] / 256;
    }
    const double beam = c.mu0 * c.beam;
    all[down] = {beam * (mean - (down ? std::exp(-tau / c.mu0) : 0)), beam * std::sqrt(square)};
  }
  return all;
}

// Within 4 standard errors; and within 0.5 % where these are small enough for that to be told (3 of them in the bound).
// Returns whether they are.
bool expect_flux(double got, double error, double reference, const std::string& what) {
  if (reference < 1e-5) return true;  // the table's own noise
  const bool resolved = 3 * error < kBound * reference;
  std::printf("%-20s %.5e, table %.5e, %+.3f %% (standard error %.3f %%)%s\n", what.c_str(), got, reference,
              100 * (got / reference - 1), 100 * error / reference, resolved ? "" : " unresolved");
  EXPECT_NEAR(got, reference, 4 * error + kRounding * reference) << what;
  if (resolved) {
    EXPECT_NEAR(got, reference, kBound * reference) << what;
  }
  return resolved;
}

std::shared_ptr<Scene> body_of(const Case& c, double tau, double albedo) {
  return slab_scene(medium(Curve::constant(tau * (1 - albedo)), Curve::constant(tau * albedo), c.phase), 1);
}

class DisortSlab : public testing::TestWithParam<Case> {};

// The explicit sun, seen from all directions above and below.
TEST_P(DisortSlab, FluxesOfABody) {
  const Case c = GetParam();
  const auto table = references();
  ASSERT_TRUE(table.count(c.name)) << "reference data are missing";
  const Reference reference = table.at(c.name);
  const uint32_t paths = long_run() ? 1u << 14 : deep(reference.bottom) ? 1u << 12 : 1u << 13;
  const Fluxes f = fluxes(body_of(c, reference.bottom, c.albedo), c, 1, paths);
  expect_flux(f.up, f.up_error, reference.up, c.name + " up, sun");
  expect_flux(f.down, f.down_error, reference.down, c.name + " down, sun");
}

TEST_P(DisortSlab, FluxesByReciprocity) {
  const Case c = GetParam();
  const Reference reference = references().at(c.name);
  const auto f = fluxes_by_reciprocity(body_of(c, reference.bottom, c.albedo), c, reference.bottom, 1, powers_of(c));
  const bool up = expect_flux(f[0].value, f[0].error, reference.up, c.name + " up");
  const bool down = expect_flux(f[1].value, f[1].error, reference.down, c.name + " down");
  EXPECT_TRUE(up || !long_run());
  EXPECT_TRUE(down || !long_run() || c.name == "1f");
}

// The same slab as a grid of 3 x 3 x 5 cells. Beams enter in its middle; it is wide enough that what leaves through its
// sides is far less than 1e-5 of them.
TEST_P(DisortSlab, FluxesOfAGrid) {
  const Case c = GetParam();
  const Reference reference = references().at(c.name);
  const double tau = reference.bottom, wide = 1e5;
  const Medium m = medium(Curve::constant(tau * (1 - c.albedo)), Curve::constant(tau * c.albedo), c.phase);
  const Affine3 cells = translation({-wide, -wide, 0}) * scaling({2 * wide / 3, 2 * wide / 3, 0.2});
  const auto scene = scene_with(m, grid_of({3, 3, 5}, cells, [](uint32_t, uint32_t, uint32_t) { return 1; }));
  // What deep slabs let through is left to the body.
  const std::array<int, 2> powers = long_run() ? std::array{c.up, deep(tau) ? 18 : c.down} : std::array{14, 14};
  const auto f = fluxes_by_reciprocity(scene, c, tau, 1, powers);
  const bool up = expect_flux(f[0].value, f[0].error, reference.up, c.name + " up, grid");
  const bool down = expect_flux(f[1].value, f[1].error, reference.down, c.name + " down, grid");
  EXPECT_TRUE(!long_run() || (up && (down || deep(tau))));
}

TEST(DisortSlabControl, OnePercentOfAlbedoIsSeen) {
  // Problems with their albedo 1 % lower must fail the comparison, by the same rule.
  for (const size_t i : {4u, 5u, 11u}) {
    const Case c = cases()[i];
    const Reference reference = references().at(c.name);
    const auto f =
        fluxes_by_reciprocity(body_of(c, reference.bottom, 0.99 * c.albedo), c, reference.bottom, 1, {14, 8});
    EXPECT_GT(std::fabs(f[0].value - reference.up), 4 * f[0].error + kRounding * reference.up) << c.name;
  }
}

// The same as one body: a box of which only z0 and z1 are given.
std::shared_ptr<Scene> layer(const Medium& m, double z0, double z1) {
  auto scene = std::make_shared<Scene>();
  scene->media = {m};
  scene->materials = {boundary(0)};
  place(*scene, PrimitiveKind::box, {0, 0, z0, 0, 0, z1}, 0);
  check_scene(*scene, "layer");
  return scene;
}

TEST(Layer, TransmitsAsItsThicknessSays) {
  // From below, inside and above, upright and slanted, near the middle and a hundred thousand kilometres off it.
  const double absorption = 0.3, z0 = 2, z1 = 5;
  const auto scene = layer(medium(Curve::constant(absorption), Curve::constant(0)), z0, z1);
  EXPECT_TRUE(Tracer(scene).bounds().empty()) << "it has no end";
  SourceSpecs sources;
  sources.add(uniform_sky(1, false));
  std::vector<Ray> looks;
  std::vector<double> expected;
  for (const double z : {-1e3, 0.0, 2.5, 4.0, 6.0})
    for (const double zenith : {0.0, 0.5, 1.2, 1.5})
      for (const double x : {0.0, 1e8}) {
        looks.push_back({{x, -3, z}, {std::sin(zenith), 0, std::cos(zenith)}, 0});
        const double run = std::clamp(z1 - std::max(z, z0), 0.0, z1 - z0) / std::cos(zenith);
        expected.push_back(std::exp(-absorption * run));
      }
  const auto run = render(scene, sources, std::make_unique<RaySensor>(looks, one_band(), 4), {});
  for (size_t i = 0; i < looks.size(); ++i)
    EXPECT_NEAR(run.result.radiance[i], expected[i], 1e-6) << looks[i].origin.z << " " << looks[i].direction.x;
}

TEST(Layer, ScattersAsTheTablesOfASlab) {
  for (const size_t i : {0u, 6u, 10u}) {
    const Case c = cases()[i];
    const Reference reference = references().at(c.name);
    const double tau = reference.bottom;
    const auto scene =
        layer(medium(Curve::constant(tau * (1 - c.albedo)), Curve::constant(tau * c.albedo), c.phase), 0, 1);
    const Fluxes f = fluxes(scene, c, 1, 1u << 14);
    expect_flux(f.up, f.up_error, reference.up, c.name + " up, layer");
    expect_flux(f.down, f.down_error, reference.down, c.name + " down, layer");
    // Half as thick it must not pass.
    const Fluxes half = fluxes(layer(scene->media[0], 0, 0.5), c, 1, 1u << 14);
    EXPECT_GT(std::fabs(half.up - reference.up), 4 * half.up_error + kRounding * reference.up) << c.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, DisortSlab, testing::ValuesIn(cases()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace suite::test::media_slab_test
