// Temperatures at points of coarse elements, against those of elements so small that they have them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "heat/heat_field.h"
#include "heat/point_heat.h"
#include "support/heated_scene_kit.h"
#include "support/slab_kit.h"

namespace suite::final_gather_test {
namespace {

using namespace test;

constexpr double kYard = 4;  // m

// A yard and a board over it, whose shadow goes over the yard. kelvin: of the board.
HeatedScene yard(double kelvin) {
  HeatedScene s;
  TemperatureSpec soil = heat({}, {{"convection", "mcadams"}});
  soil.layers = {uniform(0.4, 1600, 900, 0.8)};
  s.plane(kYard, kYard, s.heated(0.9, soil));
  s.plane(1, 6, s.given(1, kelvin), shifted({0.2, 0, 1.2}));
  return s;
}

struct Solved {
  HeatKit kit;
  HeatSpec spec;
  WeatherLoads loads;
  HeatResult result;
  // beam_alone: no light of the sky.
  Solved(size_t budget, uint32_t paths, const Weather& weather, double kelvin, bool beam_alone)
      : Solved(HeatKit(yard(kelvin), budget), paths, weather, beam_alone) {}
  Solved(HeatKit made, uint32_t paths, const Weather& weather, bool beam_alone) : kit(std::move(made)) {
    spec.span = {0, 86400}, spec.step = 600, spec.paths = paths, spec.tolerance = 1e-3;
    loads = summer_loads(weather, spec);
    if (beam_alone) std::ranges::fill(loads.global, 0.0);
    result = kit.solve(loads, spec);
  }
  HeatScene scene() const { return {*kit.tracer, *kit.elements, *kit.faces, kit.optics}; }
};

// Root mean squares over a yard and hours of a day, K: of points of coarse elements, and of these, from fine ones.
struct Off {
  double points = 0, elements = 0;
};

Off off_fine_elements(double kelvin, bool beam_alone) {
  const Weather weather = summer_weather();
  const Solved fine(64 * 16, 256, weather, kelvin, beam_alone);
  Solved coarse(16, 2048, weather, kelvin, beam_alone);
  coarse.result.straight = straight_sunlight(coarse.scene(), coarse.loads, coarse.result, coarse.spec);
  const PointHeat points(coarse.scene(), coarse.loads, coarse.result);
  Off off;
  double count = 0;
  for (const double hour : {9.0, 12.0, 15.0, 23.0})
    for (uint32_t e = 0; e < fine.kit.elements->size(); ++e) {
      if ((*fine.kit.elements)[e].material != 0) continue;
      const double t = hour * 3600, exact = fine.result.kelvin_at(e, t);
      // The mean over the fine element.
      const SampleStream stream(7, 0, e);
      constexpr uint32_t kPoints = 8;
      double told = 0, element = 0;
      for (uint32_t k = 0; k < kPoints; ++k) {
        const Hit hit = fine.kit.elements->point(e, {stream, k, 0});
        const HeatedPlace place{hit.position, hit.normal, fine.kit.tracer->object(hit.object).instance, hit.triangle,
                                0};
        const uint32_t in = coarse.kit.elements->at(place, 0, t).value();
        const double T = coarse.result.kelvin_at(in, t);
        element += T / kPoints, told += (T + (points.tells(in, t) ? points.above(in, place, t).value() : 0)) / kPoints;
      }
      off.points += std::pow(told - exact, 2), off.elements += std::pow(element - exact, 2), ++count;
    }
  std::printf(
      "%s, board of %g K: points off fine elements by %.3f K (root mean square), coarse elements by %.3f K; "
      "%.0f us a point\n",
      beam_alone ? "beam alone" : "beam and sky", kelvin, std::sqrt(off.points / count),
      std::sqrt(off.elements / count), 1e6 * points.seconds() / static_cast<double>(points.asked()));
  return {std::sqrt(off.points / count), std::sqrt(off.elements / count)};
}

// What differs from place to place is the beam alone: the board is as warm as the sky seems.
TEST(FinalGather, ShadowsAreAsSharpAsOfFineElements) {
  const Off off = off_fine_elements(276.2, true);
  EXPECT_LT(off.points, 0.1);
  EXPECT_GT(off.elements, 1);
}

// What points take from their element instead: a board 1.2 m overhead, warmer than the sky and in the way of its light,
// differs within an element of 1 m.
TEST(FinalGather, TheRestIsThatOfTheElement) {
  const Off off = off_fine_elements(295, false);
  EXPECT_LT(off.points, 0.3);
  EXPECT_GT(off.elements, 1);
}

// A point whose temperature does not settle, as under a beam of 1e7 W/m2, has its element's and how much places differ
// from that as an error; others do not.
TEST(FinalGather, WhatDoesNotSettleHasTheErrorOfItsElement) {
  Solved s(16, 64, summer_weather(), 295, false);
  s.result.straight = straight_sunlight(s.scene(), s.loads, s.result, s.spec);
  const double t = 12 * 3600;
  for (const bool settles : {true, false}) {
    if (!settles)
      for (float& w : s.result.straight) w = -1e7f;
    const PointHeat points(s.scene(), s.loads, s.result);
    const HeatField field(std::shared_ptr<const Elements>(std::shared_ptr<void>(), s.kit.elements.get()),
                          std::shared_ptr<const HeatResult>(std::shared_ptr<void>(), &s.result),
                          std::shared_ptr<const PointHeat>(std::shared_ptr<void>(), &points));
    size_t told = 0;
    for (uint32_t e = 0; e < s.kit.elements->size(); ++e) {
      if (!points.tells(e, t)) continue;
      const Hit hit = s.kit.elements->point(e, {SampleStream(7, 0, e), 0, 0});
      const HeatedPlace place{hit.position, hit.normal, s.kit.tracer->object(hit.object).instance, hit.triangle, 0};
      HeatErrors errors = s.result.errors_at(e, t);
      if (settles) errors.size = 0;
      EXPECT_EQ(points.above(e, place, t).has_value(), settles);
      EXPECT_EQ(field.error(place, t), errors.total());
      if (!settles) {
        EXPECT_EQ(field.kelvin(place, t), s.result.kelvin_at(e, t));
      }
      ++told;
    }
    EXPECT_GT(told, 0u);
    EXPECT_EQ(points.asked(), told) << "the same place twice running";
    EXPECT_EQ(points.unsettled(), settles ? 0u : told);
    EXPECT_THAT(lines_of(points.diagnostics()),
                testing::Conditional(settles, testing::IsEmpty(), testing::ElementsAre(testing::HasSubstr("[DR607]"))));
  }
}

// Half a yard that is driven away at noon: its points have their elements' temperatures and errors, and are counted.
TEST(FinalGather, WhatStandsElsewhereHasTheTemperatureOfItsElement) {
  const auto moving = [](bool moves) {
    HeatedScene s = yard(295);
    TemperatureSpec soil = heat({}, {{"convection", "mcadams"}});
    soil.layers = {uniform(0.4, 1600, 900, 0.8)};
    s.plane(kYard, kYard, s.heated(0.9, soil), shifted({0.3, 0, 0.4}));
    const Pose here{{}, {0.3, 0, 0.4}}, there{{}, {300, 0, 0.4}};
    if (moves) s.moves(keyframe_track({{0, here}, {43190, here}, {43210, there}, {86400, there}}));
    return s;
  };
  for (const bool moves : {true, false}) {
    Solved s(HeatKit(moving(moves), 32, {0, 86400}, {}, 600), 64, summer_weather(), false);
    s.result.straight = straight_sunlight(s.scene(), s.loads, s.result, s.spec);
    const PointHeat points(s.scene(), s.loads, s.result);
    const double t = 11 * 3600;
    size_t displaced = 0;
    for (uint32_t e = 0; e < s.kit.elements->size(); ++e) {
      if (!points.tells(e, t)) continue;
      const Hit hit = s.kit.elements->point(e, {SampleStream(7, 0, e), 0, 0});
      const HeatedPlace place{hit.position, hit.normal, s.kit.tracer->object(hit.object).instance, hit.triangle, 0};
      const bool here = !s.kit.elements->changes_place(e);
      displaced += here ? 0 : 1;
      EXPECT_EQ(points.above(e, place, t).has_value(), here) << e;
    }
    EXPECT_EQ(displaced > 0, moves);
    EXPECT_EQ(points.displaced(), displaced);
    EXPECT_THAT(lines_of(points.diagnostics()),
                testing::Conditional(moves, testing::ElementsAre(testing::HasSubstr("[DR606]")), testing::IsEmpty()));
  }
}

}  // namespace
}  // namespace suite::final_gather_test
