// Fluxes of plane-parallel scattering slabs against DISORT's published test problems 1-3 (K. Stamnes et al.,
// "Numerically stable algorithm for discrete-ordinate-method radiative transfer", Appl. Opt. 27, 1988), as a body
// between two surfaces and as a voxel grid.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/support/media_kit.h"

namespace suite::test {
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
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
std::vector<Case> cases() {
  const ModelSpec rayleigh{"rayleigh", {}, {}, {}, nullptr};
  const double dim = kPi / 0.1;
  return {
      {"1a", 0.2, 0.1, dim, hg(0)},         {"1b", 1, 0.1, dim, hg(0)},         {"1c", 0.99, 0.1, dim, hg(0)},
      {"1d", 0.2, 0.1, dim, hg(0)},         {"1e", 1, 0.1, dim, hg(0)},         {"1f", 0.99, 0.1, dim, hg(0)},
      {"2a", 0.5, 0.080442, kPi, rayleigh}, {"2b", 1, 0.080442, kPi, rayleigh}, {"2c", 0.5, 0.080442, kPi, rayleigh},
      {"2d", 1, 0.080442, kPi, rayleigh},   {"3a", 1, 1, kPi, hg(0.75)},        {"3b", 1, 1, kPi, hg(0.75)}};
}

// Both fluxes with their standard errors.
struct Fluxes {
  double up, down, up_error, down_error;
};
Fluxes fluxes(const std::shared_ptr<const Scene>& scene, const Case& c, double thickness, uint32_t paths) {
  SourceSpecs sources;
  sources.sun = SunSpec{{std::sqrt(1 - c.mu0 * c.mu0), 0, c.mu0}, 0, Curve::constant(c.beam)};
  const std::vector<Ray> looks{{{0, 0, thickness + 0.5}, {0, 0, -1}, 0}, {{0, 0, -0.5}, {0, 0, 1}, 0}};
  PipelineOptions options;
  options.seed = 7;
  options.roulette_after = 30;
  const auto run = render(scene, sources, std::make_unique<FluxSensor>(looks, one_band(), paths), options);
  EXPECT_EQ(run.report.statistics.failures, 0u);
  const auto& r = run.result;
  return {kPi * r.radiance[0], kPi * r.radiance[1], kPi * r.standard_error[0], kPi * r.standard_error[1]};
}

// SUITE_MEDIA_PATHS multiplies the paths of the default run, for the 0.5 % that those do not resolve.
uint32_t effort() {
  const char* more = std::getenv("SUITE_MEDIA_PATHS");
  return more ? static_cast<uint32_t>(std::atoi(more)) : 1;
}

constexpr double kRounding = 2e-5;  // of the table, relative

// Within 4 standard errors; where these are small enough, that is within 0.5 %.
void expect_flux(double got, double error, double reference, const std::string& what) {
  if (reference < 1e-5) return;  // the table's own noise
  std::printf("%-8s %.5e, table %.5e, %+.3f %% (standard error %.3f %%)\n", what.c_str(), got, reference,
              100 * (got / reference - 1), 100 * error / reference);
  EXPECT_NEAR(got, reference, 4 * error + kRounding * reference) << what;
  if (error < 1e-3 * reference) {
    EXPECT_NEAR(got, reference, 5e-3 * reference) << what;
  }
}

class DisortSlab : public testing::TestWithParam<Case> {};

TEST_P(DisortSlab, FluxesOfABody) {
  const Case c = GetParam();
  const auto table = references();
  ASSERT_TRUE(table.count(c.name)) << "reference data are missing";
  const Reference reference = table.at(c.name);
  const double tau = reference.bottom;
  const auto scene =
      slab_scene(medium(Curve::constant(tau * (1 - c.albedo)), Curve::constant(tau * c.albedo), c.phase), 1);
  const Fluxes f = fluxes(scene, c, 1, (tau > 1 ? 1u << 15 : 1u << 16) * effort());
  expect_flux(f.up, f.up_error, reference.up, c.name + " up");
  expect_flux(f.down, f.down_error, reference.down, c.name + " down");
}

// The same slab as a grid of 3 x 3 x 5 cells, large enough that its sides do not matter.
TEST_P(DisortSlab, FluxesOfAGrid) {
  const Case c = GetParam();
  const Reference reference = references().at(c.name);
  if (c.mu0 < 0.5 && reference.bottom < 1)
    GTEST_SKIP() << "grazing light through a thin slab needs a grid of many kilometres";
  const double tau = reference.bottom, wide = 2000;
  const Medium m = medium(Curve::constant(tau * (1 - c.albedo)), Curve::constant(tau * c.albedo), c.phase);
  const Affine3 cells = translation({-wide, -wide, 0}) * scaling({2 * wide / 3, 2 * wide / 3, 0.2});
  const auto scene = scene_with(m, grid_of({3, 3, 5}, cells, [](uint32_t, uint32_t, uint32_t) { return 1; }));
  const Fluxes f = fluxes(scene, c, 1, (1u << 14) * effort());
  expect_flux(f.up, f.up_error, reference.up, c.name + " up");
  expect_flux(f.down, f.down_error, reference.down, c.name + " down");
}

TEST(DisortSlabControl, TwoPercentAreSeen) {
  // The slab of problem 3b with 2 % more absorption than it should have must fail the same comparison.
  const Case c = cases().back();
  const Reference reference = references().at(c.name);
  const double tau = reference.bottom;
  const auto scene = slab_scene(medium(Curve::constant(tau * 0.02), Curve::constant(tau * 0.98), c.phase), 1);
  const Fluxes f = fluxes(scene, c, 1, 1 << 14);
  EXPECT_GT(std::fabs(f.up - reference.up), 4 * f.up_error + kRounding * reference.up);
}

INSTANTIATE_TEST_SUITE_P(Problems, DisortSlab, testing::ValuesIn(cases()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace suite::test
