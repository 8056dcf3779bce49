// All elements of a small scene through a day.
#include "heat/surfaces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "support/heat_kit.h"
#include "support/message_of.h"
#include "support/slab_kit.h"

namespace suite::surfaces_test {
namespace {

using namespace test;
using Entry = ExchangeMatrix::Entry;

using Law = std::shared_ptr<const ConvectionLaw>;

void set_face(FaceTraits& face, double emissivity, const Law& law, double cosine_up, double wetness) {
  face.emissivity = emissivity;
  face.convection = law;
  face.cosine_up = cosine_up;
  face.wetness = wetness;
}

// Ground (rows 0, 1), leaves above it (fronts 2, 3, backs 4, 5), a thin roof sheet (front 6, back 7), a sky.
struct Grove {
  ExchangeMatrix exchange{8, 1};
  std::vector<SurfaceGroup> groups;
  SurfaceLoads loads;

  explicit Grove(bool sun = true, int steps_an_hour = 6) {
    const double row[8][9] = {{0, 0.1, 0, 0, 0.3, 0.2, 0, 0.1, 0.3}, {0.1, 0, 0, 0, 0.2, 0.3, 0, 0.1, 0.3},
                              {0, 0, 0, 0, 0, 0, 0, 0.2, 0.8},       {0, 0, 0, 0, 0, 0, 0, 0.2, 0.8},
                              {0.3, 0.2, 0, 0, 0, 0.3, 0, 0, 0.2},   {0.2, 0.3, 0, 0, 0.3, 0, 0, 0, 0.2},
                              {0, 0, 0, 0, 0, 0, 0.1, 0, 0.9},       {0.1, 0.1, 0.2, 0.2, 0, 0, 0, 0.2, 0.2}};
    for (const auto& shares : row) {
      std::vector<Entry> entries;
      for (uint32_t j = 0; j < 9; ++j) entries.push_back({j, shares[j]});
      exchange.add_row(entries);
    }
    const Law wind(make_convection({"mcadams", {}, ""}));
    const Law tarp(make_convection({"tarp", {}, ""}));
    groups.resize(3);
    groups[0].layers = {uniform(1e-4, 1400, 1000, 0.2), uniform(1, 1800, 900, 1)};
    set_face(groups[0].front, 0.95, tarp, 1, 0.1);
    groups[0].front_rows = {0, 1};
    set_face(groups[1].front, 0.97, wind, 0.7, 0.3);
    set_face(groups[1].back, 0.97, wind, -0.7, 0.3);
    groups[1].front_rows = {2, 3};
    groups[1].back_rows = {4, 5};
    groups[2].layers = {uniform(1e-3, 7800, 480, 50)};
    set_face(groups[2].front, 0.3, tarp, 1, 0);
    set_face(groups[2].back, 0.9, wind, -1, 0);
    groups[2].cosine_up = {0.8};
    groups[2].front_rows = {6};
    groups[2].back_rows = {7};
    loads.steps.assign(24 * static_cast<size_t>(steps_an_hour), 3600.0 / steps_an_hour);
    const size_t moments = loads.steps.size() + 1;
    loads.air.repeat = true;
    for (int i = 0; i <= 48; ++i) {
      const double c = i == 48 ? 1 : std::cos(2 * kPi * i / 48);
      loads.air.times.push_back(1800.0 * i);
      loads.air.kelvin.push_back(sun ? 288 - 5 * c : 288);
      loads.air.wind.push_back(sun ? 2 - c : 2);
      loads.air.vapour_pressure.push_back(sun ? 1000 : saturation_pressure(288));
    }
    const double share[8] = {0.3, 0.1, 0.5, 0.4, 0.05, 0.05, 0.6, 0.02};
    std::vector<float> absorbed;
    for (const double s : share)
      for (size_t k = 0; k < moments; ++k) {
        const double up =
            std::fmax(0.0, -std::cos(2 * kPi * static_cast<double>(k) / static_cast<double>(moments - 1)));
        absorbed.push_back(static_cast<float>(sun ? s * 800 * up * up : 0));
      }
    loads.absorbed = CompactRows(absorbed, moments);
    loads.outside.assign(moments, sun ? 320 : black(288));
  }
};

TEST(Surfaces, AllAtOneTemperatureStay) {
  const Grove still(false);
  CoupledSurfaces surfaces(still.groups, still.exchange);
  surfaces.start(270);
  SurfaceOptions options;
  options.past.tolerance = 1e-9;
  options.coupling.tolerance = 1e-8;
  const SurfaceHistory h = surfaces.solve(still.loads, options);
  double worst = 0;
  for (const double T : h.kelvin.values()) worst = std::fmax(worst, std::fabs(T - 288));
  std::printf("one temperature: %.1e K, %d sweeps\n", worst, h.coupling.sweeps);
  EXPECT_LT(worst, 1e-6);
}

// Every face's balance at full hours: leaves lose what they take; the means over the day of the ground, whose back is
// adiabatic, and of the sheet's both faces together sum to nothing. Means by the trapezoidal rule over the steps.
TEST(Surfaces, BalancesClose) {
  const Grove grove(true, 12);
  CoupledSurfaces surfaces(grove.groups, grove.exchange);
  surfaces.start(285);
  SurfaceOptions options;
  options.coupling.tolerance = 1e-4;
  const SurfaceHistory h = surfaces.solve(grove.loads, options);
  const auto flux = [&](size_t face, size_t k, const FaceTraits& traits) {
    const double t = 86400.0 * static_cast<double>(k) / static_cast<double>(h.moments - 1);
    const auto at = [&](const std::vector<double>& v) {
      return AveragedTable(grove.loads.air.times, v, AveragedTable::Between::linear, true).over(t, t + 1e-3).begin;
    };
    FaceWeather w;
    w.absorbed = grove.loads.absorbed.at(face, k);
    w.longwave = h.received.at(face, k);
    w.air_kelvin = at(grove.loads.air.kelvin), w.wind = at(grove.loads.air.wind);
    w.vapour_pressure = at(grove.loads.air.vapour_pressure);
    return net_flux(traits, w, h.kelvin_at(face, k));
  };
  double worst_leaf = 0, mean[3] = {}, absorbed = 0;
  FaceTraits sheet_front = grove.groups[2].front, sheet_back = grove.groups[2].back;
  sheet_front.cosine_up = 0.8, sheet_back.cosine_up = -0.8;
  for (size_t k = 0; k < h.moments; ++k) {
    worst_leaf = std::fmax(worst_leaf, std::fabs(flux(2, k, grove.groups[1].front) + flux(4, k, grove.groups[1].back)));
    if (k + 1 == h.moments) break;
    const double weight = 1 / static_cast<double>(h.moments - 1);
    for (size_t g = 0; g < 2; ++g) mean[g] += weight * flux(g, k, grove.groups[0].front);
    mean[2] += weight * (flux(6, k, sheet_front) + flux(7, k, sheet_back));
    absorbed += weight * grove.loads.absorbed.at(0, k);
  }
  std::printf("balances: leaves %.2e W/m2; means of the day %.3f %.3f %.3f W/m2 of %.0f absorbed, %d sweeps\n",
              worst_leaf, mean[0], mean[1], mean[2], absorbed, h.coupling.sweeps);
  EXPECT_LT(worst_leaf, 0.05);
  for (const double m : mean) EXPECT_LT(std::fabs(m), 0.001 * absorbed);
}

// A day that repeats, simulated once more as a day that goes on, is itself; halving the steps changes little.
TEST(Surfaces, PastDaysAndSteps) {
  const Grove grove, finer(true, 12);
  CoupledSurfaces surfaces(grove.groups, grove.exchange), fine(finer.groups, finer.exchange);
  surfaces.start(285);
  fine.start(285);
  SurfaceOptions next;
  next.periodic = false;
  const SurfaceHistory a = surfaces.solve(grove.loads), b = surfaces.solve(grove.loads, next),
                       c = fine.solve(finer.loads);
  double again = 0, halved = 0;
  for (size_t f = 0; f < 8; ++f)
    for (size_t k = 0; k < a.moments; ++k) {
      again = std::fmax(again, std::fabs(a.kelvin_at(f, k) - b.kelvin_at(f, k)));
      halved = std::fmax(halved, std::fabs(a.kelvin_at(f, k) - c.kelvin_at(f, 2 * k)));
    }
  std::printf("the day again: %.1e K; in half the steps: %.1e K; %d and %d sweeps\n", again, halved, a.coupling.sweeps,
              b.coupling.sweeps);
  EXPECT_LT(a.past_distance, 1e-3);
  EXPECT_LT(again, 0.01);
  EXPECT_LT(halved, 0.1);
}

TEST(Surfaces, DoNotDependOnThreads) {
  const Grove grove;
  std::vector<double> kelvin[2];
  for (int k = 0; k < 2; ++k) {
    set_threads(k + 1);
    CoupledSurfaces surfaces(grove.groups, grove.exchange);
    surfaces.start(285);
    kelvin[k] = surfaces.solve(grove.loads).kelvin.values();
  }
  set_threads(0);
  EXPECT_EQ(kelvin[0], kelvin[1]);
}

TEST(Surfaces, RefuseWhatDoesNotFit) {
  Grove grove;
  auto groups = grove.groups;
  groups[0].front_rows = {0, 0};
  EXPECT_NE(message_of([&] { CoupledSurfaces(groups, grove.exchange); }).find("one each"), std::string::npos);
  groups = grove.groups;
  groups[1].back_rows = {4};
  EXPECT_NE(message_of([&] { CoupledSurfaces(groups, grove.exchange); }).find("open backs"), std::string::npos);
  groups = grove.groups;
  groups[1].behind.value = 3;
  EXPECT_NE(message_of([&] { CoupledSurfaces(groups, grove.exchange); }).find("behind"), std::string::npos);
  CoupledSurfaces surfaces(grove.groups, grove.exchange);
  surfaces.start(285);
  grove.loads.outside.clear();
  EXPECT_NE(message_of([&] { surfaces.solve(grove.loads); }).find("8 faces and 1 outsides"), std::string::npos);
}

// The message did not say which of many materials it was about.
TEST(Surfaces, LeavesWithoutABalanceAreNamed) {
  Grove grove;
  for (FaceTraits* face : {&grove.groups[1].front, &grove.groups[1].back}) set_face(*face, 0, Law(), 1, 0);
  grove.groups[1].front_emissivity = grove.groups[1].back_emissivity = {0, 0};
  grove.groups[1].name = "leaf";
  CoupledSurfaces surfaces(grove.groups, grove.exchange);
  surfaces.start(285);
  EXPECT_NE(message_of([&] { surfaces.solve(grove.loads); }).find("material 'leaf': a leaf or sheet without heat"),
            std::string::npos);
}

}  // namespace
}  // namespace suite::surfaces_test
