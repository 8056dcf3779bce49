// Surfaces that exchange infrared: how little their steps matter, for films and for gusts.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "support/heated_scene_kit.h"
#include "support/slab_kit.h"

namespace suite::coupled_steps_test {
namespace {

using namespace test;

// Ground and a wall on it, made of layers, in McAdams' wind.
HeatKit corner(std::vector<SlabLayer> layers) {
  HeatedScene s;
  TemperatureSpec spec = heat({}, {{"convection", "mcadams"}});
  spec.layers = std::move(layers);
  const uint32_t m = s.heated(0.9, spec);
  s.plane(4, 4, m);
  s.plane(3, 4, m, with_axes({0, 0, 1}, {0, 1, 0}, {2, 0, 1.5}));
  return HeatKit(std::move(s), 2);
}

// A sunny day: what is absorbed, and air that repeats.
SurfaceLoads day(const HeatKit& kit, const std::vector<double>& steps, const AirSeries& air) {
  SurfaceLoads loads;
  loads.steps = steps;
  loads.air = air;
  std::vector<double> moments{0};
  for (const double dt : steps) moments.push_back(moments.back() + dt);
  std::vector<float> absorbed;
  for (size_t f = 0; f < kit.faces->size(); ++f)
    for (const double t : moments) {
      const double up = std::fmax(0.0, -std::cos(2 * kPi * t / 86400));
      absorbed.push_back(static_cast<float>((f == 0 ? 650 : 400) * up * up));
    }
  loads.absorbed = CompactRows(absorbed, moments.size());
  loads.outside.assign(kit.faces->outsides() * moments.size(), 320);
  return loads;
}

AirSeries air_of(double step, const std::function<double(int)>& wind) {
  AirSeries air;
  air.repeat = true;
  const int n = static_cast<int>(std::lround(86400 / step));
  for (int i = 0; i <= n; ++i) {
    air.times.push_back(step * i);
    air.kelvin.push_back(288 - 5 * std::cos(2 * kPi * i / n));
    air.wind.push_back(wind(i % n));
    air.vapour_pressure.push_back(0);
  }
  return air;
}

struct DayRun {
  std::vector<std::vector<double>> hours;  // K by face, at full hours
  std::vector<std::vector<double>> means;  // K by face, over the hours
  int sweeps = 0;
};

// A day as it goes on from the periodic state of steps of ten minutes.
DayRun run(const HeatKit& kit, const ExchangeMatrix& matrix, const std::vector<double>& emissivity,
           const AirSeries& past, const AirSeries& air, const std::vector<double>& steps) {
  CoupledSurfaces surfaces(surface_groups(*kit.elements, *kit.faces, kit.optics, emissivity), matrix);
  surfaces.start(285);
  surfaces.solve(day(kit, std::vector<double>(144, 600.0), past));
  SurfaceOptions options;
  options.periodic = false;
  const SurfaceHistory h = surfaces.solve(day(kit, steps, air), options);
  DayRun out;
  out.sweeps = h.coupling.sweeps;
  for (size_t f = 0; f < kit.faces->size(); ++f) {
    std::vector<double>&at = out.hours.emplace_back(), &mean = out.means.emplace_back();
    double t = 0, sum = 0;
    for (size_t k = 0; k < steps.size(); ++k) {
      t += steps[k], sum += steps[k] * (h.kelvin_at(f, k) + h.kelvin_at(f, k + 1)) / 2;
      if (std::fabs(t / 3600 - std::round(t / 3600)) > 1e-7) continue;
      at.push_back(h.kelvin_at(f, k + 1)), mean.push_back(sum / 3600), sum = 0;
    }
    EXPECT_EQ(at.size(), 24u);
  }
  return out;
}

double largest(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b) {
  double worst = 0;
  for (size_t f = 0; f < a.size(); ++f)
    for (size_t i = 0; i < a[f].size(); ++i) worst = std::fmax(worst, std::fabs(a[f][i] - b[f].at(i)));
  return worst;
}

// A film of 10 um on a metre of concrete, in steps of 10 min against 1 s.
TEST(CoupledSteps, FilmDoesNotDependOnTheStep) {
  const HeatKit kit = corner({uniform(1e-5, 2700, 900, 0.2), uniform(1, 2300, 880, 1.4)});
  const ExchangePaths paths = kit.exchange({8, 64, 1});
  const ExchangeMatrix matrix = paths.matrix(kit.faces->outsides());
  const AirSeries air = air_of(60, [](int) { return 2.0; });
  const auto with = [&](double step) {
    return run(kit, matrix, paths.emissivity, air, air,
               std::vector<double>(static_cast<size_t>(std::lround(86400 / step)), step));
  };
  const DayRun fine = with(1), coarse = with(600), hourly = with(3600);
  std::printf("film in a corner: steps of 600 s against 1 s %.4f K, of 3600 s %.3f K; %d and %d sweeps\n",
              largest(fine.hours, coarse.hours), largest(fine.hours, hourly.hours), coarse.sweeps, fine.sweeps);
  EXPECT_LT(largest(fine.hours, coarse.hours), 0.02);
  EXPECT_GT(largest(fine.hours, hourly.hours), 0.02);  // negative control
}

// Wind that is new every second, from 0 to 6 m/s: steps of 10 min, refined before full hours, against 0.1 s.
TEST(CoupledSteps, GustsAreAveragedAndNotAliased) {
  const HeatKit kit = corner({uniform(0.5, 2300, 880, 1.4)});
  const ExchangePaths paths = kit.exchange({8, 64, 1});
  const ExchangeMatrix matrix = paths.matrix(kit.faces->outsides());
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(0, 6);
  std::vector<double> winds(86400);
  for (double& w : winds) w = any(random);
  const AirSeries gusty = air_of(1, [&](int i) { return winds[static_cast<size_t>(i)]; });
  const AirSeries calm = air_of(600, [](int) { return 3.0; });
  const AirSeries sampled = air_of(600, [&](int i) { return winds[600 * static_cast<size_t>(i)]; });
  const std::vector<double> ten(144, 600.0);
  std::vector<double> hours;
  for (int h = 1; h <= 24; ++h) hours.push_back(3600.0 * h);
  const std::vector<double> refined = refine_steps(0, ten, hours, 1);
  const DayRun fine = run(kit, matrix, paths.emissivity, gusty, gusty, std::vector<double>(864000, 0.1));
  const DayRun plain = run(kit, matrix, paths.emissivity, gusty, gusty, ten);
  const DayRun asked = run(kit, matrix, paths.emissivity, gusty, gusty, refined);
  const DayRun quiet = run(kit, matrix, paths.emissivity, calm, calm, ten);
  const DayRun aliased = run(kit, matrix, paths.emissivity, sampled, sampled, ten);
  const auto cost = static_cast<double>(refined.size()) * asked.sweeps,
             calm_cost = static_cast<double>(ten.size()) * quiet.sweeps;
  std::printf(
      "gusts in a corner: means of hours %.4f K, at their ends %.4f K, with refined steps %.4f K (at %.2f times the "
      "calm cost); sampled, means of hours %.3f K\n",
      largest(fine.means, plain.means), largest(fine.hours, plain.hours), largest(fine.hours, asked.hours),
      cost / calm_cost, largest(fine.means, aliased.means));
  EXPECT_LT(largest(fine.means, plain.means), 0.05);
  EXPECT_LT(largest(fine.hours, asked.hours), 0.05);
  EXPECT_LE(cost, 3 * calm_cost);
  EXPECT_GT(largest(fine.means, aliased.means), 0.15);  // negative control
}

}  // namespace
}  // namespace suite::coupled_steps_test
