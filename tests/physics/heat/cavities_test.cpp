// Traced exchange of infrared in cavities, between plates, shields: closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "support/heated_stack_kit.h"
#include "support/slab_kit.h"

namespace suite::cavities_test {
namespace {

using namespace test;

// A closed box with things in it, of emissivities 0.02 to 1, some without heat capacity, one of conducting layers with
// a source of nothing behind it; one wall is held.
TEST(Cavities, OneTemperatureStays) {
  HeatedScene s;
  const TemperatureSpec thick =
      heat({{"thickness_m", 0.1}, {"density_kg_m3", 2000}, {"specific_heat_j_kg_k", 900}, {"conductivity_w_m_k", 1}});
  const uint32_t held = s.heated(0.8, held_at(311.5)), bright = s.heated(0.02, heat()), half = s.heated(0.5, thick),
                 black_ = s.heated(1, heat()), leaf = s.heated(0.1, heat({}, {{"back", "open"}}));
  s.plane(2, 2, held);
  s.plane(2, 2, bright, upside_down({0, 0, 2}));
  s.plane(2, 2, half, with_axes({0, 1, 0}, {0, 0, 1}, {-1, 0, 1}));
  s.plane(2, 2, bright, with_axes({0, 0, 1}, {0, 1, 0}, {1, 0, 1}));
  s.plane(2, 2, black_, with_axes({0, 0, 1}, {1, 0, 0}, {0, -1, 1}));
  s.plane(2, 2, half, with_axes({1, 0, 0}, {0, 0, 1}, {0, 1, 1}));
  s.exact(PrimitiveKind::sphere, {0.3}, bright, shifted({0.3, 0.2, 0.8}));
  s.exact(PrimitiveKind::disk, {0.4, 0.1}, leaf, shifted({-0.3, 0, 1.4}));
  const HeatKit kit(std::move(s), 60);
  const ExchangePaths paths = kit.exchange({8, 8, 3});
  // Nothing outside is seen: what it emits does not matter.
  const SurfaceHistory h = solve_exchange(kit, paths, outsides_at(kit, 10), 250);
  double worst = 0;
  for (const double T : h.kelvin.values()) worst = std::fmax(worst, std::fabs(T - 311.5));
  std::printf("cavity: %.1e K from its temperature, %zu faces, %d sweeps, %.0f rays, %.1g unfinished\n", worst,
              kit.faces->size(), h.coupling.sweeps, paths.rays(), paths.unfinished());
  EXPECT_LT(worst, 1e-6);
  EXPECT_EQ(paths.unfinished(), 0);
  // Negative control: a hole, of one part in a hundred of the wall that is held, is felt.
  std::vector<double> outside = outsides_at(kit, 10);
  ExchangePaths open = paths;
  for (size_t k = 0; k < open.ends.size(); k += 100) open.ends[k] = kit.faces->outside_below();
  const SurfaceHistory colder = solve_exchange(kit, open, outside, 311.5);
  EXPECT_LT(std::ranges::min(colder.kelvin.values()), 311);
}

// A black plate under the closed back of one that is held at 400 K: the back is as warm as its front. Parallel unit
// squares half their side apart see each other by 0.41525 (e.g. Siegel & Howell, Thermal radiation heat transfer,
// appendix C). Negative control: asked from both ends, of which the back knows nothing, half of that would be seen.
TEST(Cavities, ClosedBackIsAsWarmAsItsElement) {
  constexpr double kFactor = 0.41525;
  HeatedScene s;
  const uint32_t plate = s.heated(1, heat());
  s.plane(1, 1, plate);
  s.plane(1, 1, s.heated(1, held_at(400)), shifted({0, 0, 0.5}));
  const HeatKit kit(std::move(s), 2);
  const ExchangePaths paths = kit.exchange({8, 4096, 1});
  const SurfaceHistory h = solve_exchange(kit, paths, outsides_at(kit, 200), 300);
  const size_t cold = (*kit.elements)[0].material == plate ? 0 : 1;
  ASSERT_EQ((*kit.elements)[cold].material, plate);
  const double seen = (black(h.kelvin.at(cold, 0)) - black(200)) / (black(400) - black(200));
  std::printf("closed back: seen by %.4f of %.4f\n", seen, kFactor);
  EXPECT_NEAR(seen, kFactor, 0.01);
  EXPECT_GT(std::fabs(kFactor / 2 / (1 - kFactor / 2) - kFactor), 0.05);
}

TEST(Cavities, PlatesAndShields) {
  struct Case {
    double emissivity;
    int shields;
    uint32_t paths;
  };
  for (const auto& [emissivity, shields, paths] : {Case{0.02, 0, 5 << 13}, Case{0.02, 1, 3 << 13},
                                                   Case{0.02, 10, 1 << 14}, Case{0.3, 2, 1 << 13}, Case{1, 4, 64}}) {
    const Stack s = stack(emissivity, shields, paths, 1);
    std::printf("plates of %.2f, %2d shields, %u paths: %.5f W/m2 of %.5f (%+.3f %%, standard error %.3f %%)\n",
                emissivity, shields, paths, s.flux, s.exact, 100 * (s.flux / s.exact - 1), 100 * s.error / s.exact);
    EXPECT_NEAR(s.flux, s.exact, 0.002 * s.exact);
    EXPECT_LT(s.error, 0.001 * s.exact);
  }
}

// The radiation shield of the Fire Dynamics Simulator's verification suite (NIST): black plates of 500 and 20 degC, a
// lead sheet of 0.1 mm of emissivity 0.48; T^4 is the mean of the plates'. Through the whole of solve_heat.
TEST(Cavities, LeadShieldBetweenBlackPlates) {
  for (const bool lead : {false, true}) {
    HeatedScene s;
    s.plane(0, 0, s.given(1, 773.15));
    s.plane(0, 0, s.given(1, 293.15), upside_down({0, 0, 2}));
    TemperatureSpec spec = heat({}, {{"back", "open"}});
    if (lead) spec.layers = {uniform(1e-4, 11340, 130, 35.3)};
    s.plane(0, 0, s.heated(0.48, spec), shifted({0, 0, 1}));
    const HeatKit kit(std::move(s), 20);
    HeatSpec run;
    run.span = {0, 86400}, run.paths = 16, run.tolerance = 1e-4, run.step = 3600;
    const HeatResult r = kit.solve(still_loads({}, run.span, 24), run);
    double worst = 0;
    for (const float T : r.kelvin) worst = std::fmax(worst, std::fabs(double{T} - 653.473));
    std::printf("shield%s: within %.4f K of 653.473 K, %zu faces\n", lead ? " of lead" : "", worst, kit.faces->size());
    EXPECT_LT(worst, 0.05);
    EXPECT_LT(std::fabs(r.balance.residual()), 1e-3 * r.balance.infrared);
  }
}

// Aluminium of 1 mm without air, adiabatic behind, absorptance and emissivity 0.02, under an empty sky and a beam of
// 459.3 W/m2 from the zenith: 300 K, and C / (4 emissivity sigma T^3) = 5.5 h to get there.
TEST(Cavities, BareAluminiumInTheSun) {
  const HeatKit kit = aluminium_sheet(0.02);
  const HeatResult r = in_the_sun(kit, 144);
  double worst = 0;
  for (const float T : r.kelvin) worst = std::fmax(worst, std::fabs(double{T} - 300));
  std::printf("aluminium: within %.4f K of 300 K; absorptance %.5f, emissivity %.5f\n", worst, double{r.absorptance[0]},
              double{r.emissivity[0]});
  EXPECT_LT(worst, 0.3);

  const ExchangePaths paths = kit.exchange({8, 8, 1});
  const ExchangeMatrix matrix = paths.matrix(kit.faces->outsides());
  SurfaceLoads loads = still_exchange(kit, outsides_at(kit, 0), {0, 5.5 * 3600}, 33);
  loads.absorbed = CompactRows(std::vector<float>(kit.faces->size() * 34, 0.02f * 459.3f), 34);
  double left[2] = {};
  for (int k = 0; k < 2; ++k) {
    CoupledSurfaces surfaces(surface_groups(*kit.elements, *kit.faces, kit.optics, paths.emissivity), matrix);
    surfaces.start(k == 0 ? 301 : 299);
    SurfaceOptions options;
    options.periodic = false;
    left[k] = surfaces.solve(loads, options).kelvin.at(0, 33);
  }
  const double hours = -5.5 / std::log((left[0] - left[1]) / 2);
  std::printf("aluminium: time constant %.4f h\n", hours);
  EXPECT_NEAR(hours, 5.5, 0.02 * 5.5);
}

}  // namespace
}  // namespace suite::cavities_test
