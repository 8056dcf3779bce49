// Random walks that audit the temperatures of elements: unbiased elements are found so, others are not.
#include <gtest/gtest.h>

#include <cmath>

#include "heat/heat_audit.h"
#include "math/stats.h"
#include "support/heated_scene_kit.h"
#include "support/slab_kit.h"

namespace suite::audit_test {
namespace {

using namespace test;

HeatSpec audited(size_t probes, uint32_t paths, double step = 1800) {
  HeatSpec spec;
  spec.span = {0, 86400}, spec.step = step;
  spec.paths = paths, spec.tolerance = 1e-4, spec.audit = probes;
  return spec;
}

TemperatureSpec wall(double thickness, double film) {
  return heat({{"thickness_m", thickness},
               {"density_kg_m3", 1600},
               {"specific_heat_j_kg_k", 900},
               {"conductivity_w_m_k", 0.8},
               {"still_w_m2_k", film},
               {"wind_j_m3_k", 0}},
              {{"convection", "constant"}});
}

void tell(const char* what, const HeatAudit& a) {
  constexpr double k = HeatAudit::kSure;
  std::printf(
      "%s: bias %+.4f +- %.4f K, by themselves %+.3f +- %.3f K, mean square %.3f +- %.3f K2 (95 %%), %zu probes, %.2g "
      "rays\n",
      what, a.bias, k * a.bias_error, a.whole, k * a.whole_error, a.square, k * a.square_error, a.probes.size(),
      a.rays);
  EXPECT_LT(std::fabs(a.whole), 3.3 * a.whole_error + 1e-3);  // 0.1 %
  EXPECT_EQ(a.cut, 0u);
  EXPECT_EQ(a.fast, 0u);
}

// Two walls and a floor that meet, in sun, sky and air that stand still: small elements are right in the mean. Shifted
// by a kelvin they are not.
TEST(Audit, CornerInSun) {
  HeatedScene s;
  const uint32_t grey = s.heated(0.7, wall(0.05, 6));
  s.plane(2, 2, grey);
  s.plane(2, 2, grey, with_axes({0, 1, 0}, {0, 0, 1}, {-1, 0, 1}));
  s.plane(2, 2, grey, with_axes({0, 0, 1}, {1, 0, 0}, {0, -1, 1}));
  const HeatKit kit(std::move(s), 200);
  const HeatSpec spec = audited(20000, 512);
  const WeatherLoads loads =
      still_loads({600, 80, 320, 290, 2, normalized(Vec3{0.5, 0.4, 0.6}), 0.00465}, spec.span, 48);
  const HeatResult result = kit.solve(loads, spec);
  tell("corner", *result.audit);
  EXPECT_LT(std::fabs(result.audit->bias), 3.3 * result.audit->bias_error);  // 0.1 %
  EXPECT_LT(result.audit->bias_error, 0.15);
  // A sun that the elements were not told of: they are found too cold.
  WeatherLoads dimmer = loads;
  for (double& direct : dimmer.direct) direct *= 0.97;
  HeatSpec unaudited = spec;
  unaudited.audit = 0;
  const HeatResult cold = kit.solve(dimmer, unaudited);
  double colder = 0;
  for (size_t i = 0; i < cold.kelvin.size(); ++i)
    colder += (double{result.kelvin[i]} - double{cold.kelvin[i]}) / static_cast<double>(cold.kelvin.size());
  EXPECT_GT(colder, 3.3 * result.audit->bias_error) << "the audit could not see a sun of 3 % less";
}

// One element, half of it under a lid: right in the mean, and everywhere wrong. Whole it is right everywhere.
TEST(Audit, ElementHalfUnderALid) {
  const auto audit = [](bool lid) {
    HeatedScene s;
    s.plane(2, 1, s.heated(0.9, wall(0.02, 5)));
    if (lid) s.plane(1, 1, s.given(1, 300), shifted({0.5, 0, 0.02}));
    const HeatKit kit(std::move(s), 1);
    const HeatSpec spec = audited(4000, 4096);
    const WeatherLoads loads = still_loads({700, 0, 300, 290, 2, {0, 0, 1}, 0}, spec.span, 48);
    const HeatResult result = kit.solve(loads, spec);
    tell(lid ? "half under a lid" : "without the lid", *result.audit);
    return *result.audit;
  };
  const HeatAudit half = audit(true), whole = audit(false);
  EXPECT_GT(half.spread(), 5);
  EXPECT_EQ(whole.spread(), 0);
  EXPECT_LT(std::fabs(whole.bias), 3.3 * whole.bias_error);
}

// A slab with 1000 W/m3 inside, black on both sides, between plates of 350 and 280 K: conduction k dT/dx and sigma T^4
// at both faces, here by bisection.
TEST(Audit, SlabWithSourceBetweenPlates) {
  constexpr double kThick = 0.1, kConducts = 1.15, kInside = 1000;
  // Front at T: flux in = sigma (350^4 - T^4); the back is then known twice.
  double low = 280, high = 400;
  for (int i = 0; i < 80; ++i) {
    const double T = (low + high) / 2, in = black(350) - black(T);
    const double back = T - (in * kThick + kInside * kThick * kThick / 2) / kConducts;
    const double out = black(std::fmax(back, 1)) - black(280);
    (in + kInside * kThick > out ? low : high) = T;
  }
  HeatedScene s;
  TemperatureSpec slab = heat({}, {{"back", "open"}});
  slab.layers = {uniform(kThick, 2000, 900, kConducts)};
  slab.layers.front().heat_generation = kInside;
  const uint32_t between = s.heated(1, slab);
  s.plane(0, 0, between);
  s.plane(0, 0, s.heated(1, held_at(350)), upside_down({0, 0, 1}));
  s.plane(0, 0, s.heated(1, held_at(280)), shifted({0, 0, -1}));
  const HeatKit kit(std::move(s), 3);
  HeatSpec spec = audited(8000, 64);
  const HeatResult result = kit.solve(still_loads({0, 0, 10, 300}, spec.span, 48), spec);
  RunningStats front;
  for (const AuditProbe& p : result.audit->probes)
    if (!kit.faces->is_back(p.face) && (*kit.elements)[kit.faces->element(p.face)].material == between)
      front.add((p.walked[0] + p.walked[1]) / 2);
  tell("slab with a source", *result.audit);
  std::printf("its front: %.3f +- %.3f K of %.3f\n", front.mean(), 1.96 * front.stderr_of_mean(), low);
  EXPECT_NEAR(front.mean(), low, 3.3 * front.stderr_of_mean() + 1e-3);
  EXPECT_LT(std::fabs(result.audit->bias), 3.3 * result.audit->bias_error + 1e-3);
}

}  // namespace
}  // namespace suite::audit_test
