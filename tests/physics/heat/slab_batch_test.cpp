// Slabs in lockstep against closed forms, a published table and the single slab.
#include "heat/slab_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "support/heat_kit.h"
#include "support/slab_kit.h"

namespace suite::slab_batch_test {
namespace {

using namespace test;

void run(SlabBatch& batch, const BatchLoads& loads, double dt, int steps) {
  for (int i = 0; i < steps; ++i) batch.step(dt, loads);
}

// A slab of 0.1 m, 1.15 W/(m K), whose black faces exchange T^4 with black surroundings: the fluxes through both faces
// and through the slab are one, or part at the parabola of its heat source. Numbers by solving these two equations.
TEST(SlabBatch, BlackFacesWithTheFourthPower) {
  SlabBatch batch({uniform(0.1, 1000, 1000, 1.15, 20)}, 2);
  batch.start(0, 300);
  run(batch, steady({{facing(1, 280), facing(1, 350)}, {facing(1, 200), facing(1, 500)}}), 1e4, 60);
  EXPECT_NEAR(batch.kelvin(0, 10), 320.3714, 1e-4);
  EXPECT_NEAR(batch.kelvin(1, 10), 416.4015, 1e-4);

  SlabLayer heated = uniform(0.1, 1000, 1000, 1.15, 20);
  heated.heat_generation = 1000;
  SlabBatch warm({heated}, 1);
  warm.start(0, 300);
  run(warm, steady({{facing(1, 280), facing(1, 350)}}), 1e4, 60);
  EXPECT_NEAR(warm.kelvin(0, 10), 327.9587, 1e-4);

  // Negative control: exchange linearised about the mean, 4 sigma T^3, is 5 K off.
  const double h = 4 * kStefanBoltzmann * std::pow(315.0, 3);
  batch.start(0, 300);
  const std::pair<FaceBalance, FaceBalance> line{{h * 280, h, 0}, {h * 350, h, 0}};
  run(batch, steady({line, line}), 1e4, 60);
  EXPECT_NEAR(batch.kelvin(0, 10), 315, 1e-4);
}

// The radiation shield of the Fire Dynamics Simulator's verification suite (NIST): a lead sheet of 0.1 mm and
// emissivity 0.48 between black plates of 500 and 20 degC. T^4 is the mean of the plates'.
TEST(SlabBatch, LeadShieldBetweenPlates) {
  SlabBatch batch({uniform(1e-4, 11340, 130, 35.3)}, 1);
  batch.start(0, 293.15);
  const auto loads = steady({{facing(0.48, 773.15), facing(0.48, 293.15)}});
  batch.advance(500, loads, {0.01, 100, 1e-9});
  EXPECT_NEAR((batch.top(0) + batch.bottom(0)) / 2, 653.473, 0.002);  // 13 mK from face to face
  EXPECT_NEAR(0.48 * (black(773.15) - black(batch.top(0))), 4762.20, 0.5);
}

// A thin sheet without air that loses its sun holds less heat than the losses of that moment would take within a long
// step: C dT/dt = -sigma T^4, so T^-3 = T0^-3 + 3 sigma t / C. Beside it dust of the same heat, against steps of 10 s.
TEST(SlabBatch, SkinThatLosesItsSun) {
  const FaceBalance dark{0, 0, kStefanBoltzmann};
  const double C = 0.002 * 1100 * 400, t = 3600;
  SlabBatch sheet({uniform(0.002, 1100, 400, 50)}, 1);
  sheet.start(0, 380);
  sheet.step(t, steady({{dark, {}}}));
  const double closed = std::cbrt(1 / (std::pow(380.0, -3) + 3 * kStefanBoltzmann * t / C));
  EXPECT_NEAR(sheet.top(0), closed, 1) << "without parts it is 0 K";
  EXPECT_EQ(sheet.time(), t);
  SlabBatch dust({uniform(0.002, 1100, 400, 0.001)}, 1), finely = dust;
  for (SlabBatch* b : {&dust, &finely}) b->start(0, 380);
  dust.step(t, steady({{dark, {}}}));
  run(finely, steady({{dark, {}}}), 10, 360);
  EXPECT_NEAR(dust.top(0), finely.top(0), 1);
  EXPECT_NEAR(dust.bottom(0), finely.bottom(0), 1);
  // Steps that need no parts take none.
  SlabBatch slow({uniform(0.2, 1100, 400, 0.1)}, 1);
  slow.start(0, 380);
  slow.step(t, steady({{dark, {}}}));
  EXPECT_EQ(slow.counters().steps, 1);
  EXPECT_GT(dust.counters().steps, 1);
}

// Flux that sets in on a thick solid: 2 F sqrt(t / pi) / inertia (Carslaw & Jaeger, Conduction of heat in solids, 2.9).
TEST(SlabBatch, StepOfFluxOnAThickSolid) {
  const double F = 500, inertia = std::sqrt(1.5 * 2.1e6);
  SlabBatch batch({uniform(0.4, 2100, 1000, 1.5, 800)}, 1), automatic({uniform(1, 2100, 1000, 1.5)}, 1);
  const auto loads = steady({{{F, 0, 0}, {}}});
  double worst = 0, worst_automatic = 0;
  for (SlabBatch* b : {&batch, &automatic}) {
    b->start(0, 290);
    for (const double t : {30.0, 60.0, 300.0, 600.0, 1800.0, 3600.0}) {
      b->advance(t, loads, {1e-3, 600, 1e-9});
      double& w = b == &batch ? worst : worst_automatic;
      w = std::fmax(w, std::fabs(b->top(0) - 290 - 2 * F * std::sqrt(t / kPi) / inertia));
    }
  }
  std::printf("step of flux: %.2e K, %.2e K on the automatic grid, of 19.1 K\n", worst, worst_automatic);
  EXPECT_LT(worst, 0.01);
  EXPECT_LT(worst_automatic, 0.01);
}

// Film of 10 um on a metre of concrete: 10 min steps against 1 s steps, at full hours of a sunny day.
TEST(SlabBatch, FilmDoesNotDependOnTheStep) {
  const Day day;
  const BatchLoads loads = day.loads();
  SlabBatch midnight({uniform(1e-5, 2700, 900, 0.2), uniform(1, 2300, 880, 1.4)}, 1);
  find_periodic(midnight, 0, std::vector<double>(144, 600.0), loads);
  midnight.restart(0);
  auto hours = [&](double dt) {
    SlabBatch batch = midnight;
    std::vector<double> kelvin;
    for (int hour = 0; hour < 24; ++hour) {
      run(batch, loads, dt, static_cast<int>(std::lround(3600 / dt)));
      kelvin.push_back(batch.top(0));
    }
    return kelvin;
  };
  const auto fine = hours(1), coarse = hours(600);
  double worst = 0;
  for (size_t i = 0; i < fine.size(); ++i) worst = std::fmax(worst, std::fabs(fine[i] - coarse[i]));
  std::printf("film: 600 s against 1 s steps %.2e K\n", worst);
  EXPECT_LT(worst, 0.02);
}

// Aluminium of 1 mm without wind, adiabatic behind, absorptance and emissivity 0.02, one face that radiates:
// 459.3 W/m2 are those of 300 K; it comes there with C / (4 eps sigma T^3) = 5.5 h.
TEST(SlabBatch, BareAluminium) {
  SlabBatch batch({uniform(1e-3, 2700, 900, 237)}, 3);
  const FaceBalance sunlit{0.02 * 459.3, 0, 0.02 * kStefanBoltzmann};
  const auto loads = steady({{sunlit, {}}, {sunlit, {}}, {sunlit, {}}});
  batch.start(0, 300);
  for (size_t node = 0; node < batch.nodes(); ++node) batch.set_kelvin(1, node, 301), batch.set_kelvin(2, node, 299);
  const double hours = 5.5;
  run(batch, loads, 600, static_cast<int>(hours * 6));
  // Half the difference of both excesses, so that what is not linear cancels.
  const double left = (batch.top(1) - batch.top(2)) / 2, constant = -hours / std::log(left);
  std::printf("aluminium: time constant %.4f h\n", constant);
  EXPECT_NEAR(constant, 5.5, 0.02 * 5.5);
  batch.start(0, 280);
  run(batch, loads, 3600, 200);
  EXPECT_NEAR(batch.top(0), 300, 1e-2);
  // Steps of a hundred time constants neither ring nor overshoot.
  batch.start(0, 310);
  batch.step(2e6, loads);
  EXPECT_NEAR(batch.top(0), 300, 1);
  batch.step(2e6, loads);
  EXPECT_NEAR(batch.top(0), 300, 0.1);
}

// Exact slab of the Fire Dynamics Simulator's verification suite (NIST): tests/data/thermal/fds/heat_conduction_c.csv.
// 0.1 m, 1 W/(m K), 1e6 J/(m3 K), insulated behind, 10 W/(m2 K) to gas of 120 degC from 20 degC.
TEST(SlabBatch, HeatConductionOfFds) {
  SlabBatch batch({uniform(0.1, 1000, 1000, 1, 100)}, 1);
  batch.start(0, 293.15);
  const auto loads = steady({{{10 * 393.15, 10, 0}, {}}});
  std::ifstream in(SUITE_TEST_DATA "/thermal/fds/heat_conduction_c.csv");
  std::string line;
  std::getline(in, line);
  int rows = 0;
  double worst = 0;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    double value = 0;
    char comma = 0;
    cells >> value;
    if (value > 0) batch.advance(value, loads, {2e-4, 1000, 1e-9});
    for (const size_t node : {100u, 80u, 60u, 40u, 20u, 0u}) {
      ASSERT_TRUE(static_cast<bool>(cells >> comma >> value));
      worst = std::fmax(worst, std::fabs(batch.kelvin(0, node) - 273.15 - value));
    }
    ++rows;
  }
  std::printf("heat_conduction_c: largest difference %.4f K in %d rows\n", worst, rows);
  EXPECT_EQ(rows, 24);
  EXPECT_LT(worst, 0.015);  // the table is rounded to 0.005 K and good to 0.005 K
}

// Regolith, whose properties depend on temperature: steps are those of the single slab, the lunar day that repeats is
// the one its spin-up finds, with the measured night (Diviner, tests/data/thermal).
TEST(SlabBatch, LunarRegolith) {
  const double period = 2.55024e6;
  const auto sun = [period](double t) { return lunar_sun(t, period); };
  const BatchLoads loads = [&](double begin, double end, const SlabBatch& batch, FaceLines& top, FaceLines& bottom) {
    for (size_t e = 0; e < batch.elements(); ++e) {
      const double share = e == 1 ? 0.5 : 1;
      top.constant[e] = {share * sun(begin), share * sun(end)};
      top.quartic[e] = 0.95 * kStefanBoltzmann;
      bottom.constant[e] = {0.018, 0.018};
    }
  };
  SlabBatch batch(lunar_regolith(), 3);
  batch.start(0, 250);
  SlabSpec spec;
  spec.layers = lunar_regolith();
  spec.top = surface(0.95, [](double) { return SurfaceLoad{900, 0, 0, 0}; });
  spec.bottom = flux(0.018);
  Slab slab(spec, {});
  slab.start(0, 250);
  double worst = 0;
  const FaceBalance lit{900, 0, 0.95 * kStefanBoltzmann}, deep{0.018, 0, 0};
  const BatchLoads noon = steady({{lit, deep}, {lit, deep}, {lit, deep}});
  for (const double dt : {1.0, 60.0, 3600.0, 20000.0, 20000.0}) {
    batch.step(dt, noon);
    double estimate = 0;
    ASSERT_TRUE(slab.step(dt, &estimate));
    EXPECT_NEAR(batch.estimate(2), estimate, 0.05 * estimate);
    for (size_t i = 0; i < batch.nodes(); ++i)
      worst = std::fmax(worst, std::fabs(batch.kelvin(2, i) - slab.kelvin()[i]));
  }
  EXPECT_LT(worst, 1e-7);

  const std::vector<double> steps(480, period / 480);
  const PeriodicResult r = find_periodic(batch, 0, steps, loads, {0.01, 60});
  std::printf("regolith: %.1e K from the slab's steps; noon %.2f K, %.2f K half lit, %d sweeps\n", worst, batch.top(0),
              batch.top(1), r.sweeps);
  EXPECT_NEAR(batch.top(0), 385.2, 0.5);  // the single slab's, printed by physics_thermal_slab
  batch.restart(0);
  double hour = 0;
  for (const double dt : steps) {
    batch.step(dt, loads);
    hour += 24.0 / 480;
    if (std::fabs(hour - 14.5) > 0.01) continue;
    EXPECT_NEAR(batch.top(0), 96.31, 2.5);  // measured at 14.49 h after noon
  }
}

// The same scheme on the same grid as the single slab: layers, a contact, a source, both faces radiating.
TEST(SlabBatch, IsTheSingleSlabManyTimes) {
  std::vector<SlabLayer> layers{uniform(1e-4, 1400, 1000, 0.2), uniform(0.01, 2300, 880, 1.4),
                                uniform(0.05, 40, 1400, 0.03)};
  layers[1].heat_generation = 300;
  layers[0].contact_resistance = 1e-3;
  const size_t elements = 37;  // not whole blocks
  SlabBatch batch(layers, elements, {60, true});
  std::vector<std::pair<FaceBalance, FaceBalance>> faces;
  const auto sun = [](size_t e) { return 20.0 * static_cast<double>(e); };
  for (size_t e = 0; e < elements; ++e)
    faces.push_back({{sun(e) + 0.9 * 350 + 12 * 290, 12, 0.9 * kStefanBoltzmann},
                     {0.6 * 400 + 3 * 295, 3, 0.6 * kStefanBoltzmann}});
  batch.start(0, 280);
  const auto loads = steady(faces);
  std::vector<Slab> slabs;
  for (size_t e = 0; e < elements; ++e) {
    const double absorbed = sun(e);
    SlabSpec spec;
    spec.layers = layers;
    spec.top = surface(
        0.9,
        [absorbed](double) {
          return SurfaceLoad{absorbed, 350, 290, 0};
        },
        12);
    spec.bottom = surface(
        0.6,
        [](double) {
          return SurfaceLoad{0, 400, 295, 0};
        },
        3);
    slabs.emplace_back(spec, SlabOptions{});
    slabs.back().start(0, 280);
  }
  double worst = 0, worst_estimate = 0;
  for (const double dt : {0.5, 10.0, 600.0, 600.0, 30.0, 3600.0}) {
    batch.step(dt, loads);
    for (size_t e = 0; e < elements; ++e) {
      double estimate = 0;
      ASSERT_TRUE(slabs[e].step(dt, &estimate));
      ASSERT_EQ(batch.nodes(), slabs[e].kelvin().size());
      for (size_t i = 0; i < batch.nodes(); ++i)
        worst = std::fmax(worst, std::fabs(batch.kelvin(e, i) - slabs[e].kelvin()[i]));
      worst_estimate = std::fmax(worst_estimate, std::fabs(batch.estimate(e) - estimate) / (1e-9 + estimate));
    }
  }
  std::printf("batch against slabs: %.2e K, estimates %.2e\n", worst, worst_estimate);
  EXPECT_LT(worst, 1e-7);
  EXPECT_LT(worst_estimate, 0.05);  // the slab's Newton matrix may be a step old
}

}  // namespace
}  // namespace suite::slab_batch_test
