// Elements that are left out because nobody sees what they do: temperatures in view against those with all of them.
#include "heat/influence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/heated_scene_kit.h"
#include "support/slab_kit.h"

namespace suite::influence_test {
namespace {

using namespace test;

constexpr size_t kBudget = 400;

// A yard that is looked at, a wall beside it, boards in rows behind the wall, each of which hides the next; boards far
// off; a warm room that nothing opens to.
HeatedScene yard_and_more() {
  HeatedScene s;
  TemperatureSpec soil = heat({}, {{"convection", "mcadams"}});
  soil.layers = {uniform(0.5, 1600, 900, 0.5)};
  TemperatureSpec heated = soil;
  heated.numbers["source_w_m2"] = 150;
  const uint32_t yard = s.heated(0.95, soil), boards = s.heated(0.9, heated);
  s.plane(4, 4, yard);
  for (int k = 0; k < 6; ++k) s.plane(6, 3, boards, with_axes({0, 1, 0}, {0, 0, 1}, {2.2 + 0.4 * k, 0, 1.5}));
  for (int k = 0; k < 12; ++k) {
    const double turn = 2 * kPi * k / 12;
    s.plane(3, 2, boards,
            with_axes({std::sin(turn), -std::cos(turn), 0}, {0, 0, 1}, {60 * std::cos(turn), 60 * std::sin(turn), 3}));
  }
  s.exact(PrimitiveKind::sphere, {1}, boards, shifted({0, 0, -40}));
  return s;
}

struct Run {
  HeatResult result;
  double off = 0;  // K, of what is seen, from the run with all
};

TEST(Influence, WhatIsSeenStaysWithinTheBound) {
  const HeatKit kit(yard_and_more(), kBudget);
  const Weather weather = summer_weather();
  HeatSpec spec;
  spec.span = {0, 86400}, spec.step = 1800, spec.tolerance = 1e-5;
  WeatherLoads night = summer_loads(weather, spec);
  // By infrared alone: the same paths in both.
  for (auto* light : {&night.direct, &night.diffuse, &night.global}) std::fill(light->begin(), light->end(), 0.0);

  const ExchangePaths exchange = kit.exchange(path_options(spec));
  const Influence influence(exchange, *kit.faces, 450);
  std::vector<bool> seen;
  for (size_t e = 0; e < kit.elements->size(); ++e) seen.push_back((*kit.elements)[e].material == 0);
  const auto [cold, warm] = std::ranges::minmax(night.air_kelvin);
  const auto solve = [&](const Elements& elements, const HeatFaces& faces, ExchangePaths paths) {
    const HeatScene scene{*kit.tracer, elements, faces, kit.optics};
    return solve_heat(scene, {std::move(paths), find_sunlight(scene, night.course, path_options(spec))}, night, spec);
  };
  const HeatResult whole = solve(*kit.elements, *kit.faces, exchange);
  const auto run = [&](const std::vector<bool>& kept) {
    Elements some(*kit.tracer, kit.optics.has_heat, kBudget, 0);
    EXPECT_EQ(some.fingerprint(), kit.elements->fingerprint());
    some.keep(kept);
    const HeatFaces few(some, kit.optics);
    const HeatResult r = solve(some, few, left_of(exchange, *kit.faces, few, kept));
    Influence::Range range{std::vector<double>(exchange.faces(), cold), std::vector<double>(exchange.faces(), warm)};
    double off = 0;
    size_t row = 0;
    for (size_t e = 0; e < kept.size(); ++e) {
      if (!kept[e]) continue;
      range.low[e] = 1e9, range.high[e] = 0;
      for (size_t k = 0; k < r.moments; ++k) {
        const double T = double{r.kelvin[row * r.moments + k]};
        range.low[e] = std::min(range.low[e], T), range.high[e] = std::max(range.high[e], T);
        if (seen[e]) off = std::max(off, std::fabs(T - double{whole.kelvin[e * r.moments + k]}));
      }
      ++row;
    }
    return std::pair{off, influence.off_at_most(seen, kept, range, {cold, warm})};
  };

  const std::vector<bool> kept = influence.kept_for(seen, 0.003, 292);
  const auto count = std::count(kept.begin(), kept.end(), true), all_seen = std::count(seen.begin(), seen.end(), true);
  const auto [off, bound] = run(kept);
  std::printf("%zu elements, %td seen, %td kept: off by %.5f K, bound %.5f K\n", kept.size(), all_seen, count, off,
              bound);
  EXPECT_LT(count, static_cast<std::ptrdiff_t>(kept.size()) * 2 / 3);
  EXPECT_GT(count, all_seen);
  EXPECT_LT(bound, 0.01);
  // Rows of elements of which some are left out are balanced anew from both ends: 2e-4 K of that.
  EXPECT_LE(off, bound + 2e-4);
  // Without all that is not seen it is another picture, and the bound knows.
  const auto [alone, alone_bound] = run(seen);
  std::printf("what is seen alone: off by %.3f K, bound %.3f K\n", alone, alone_bound);
  EXPECT_GT(alone, 0.1);
  EXPECT_GE(alone_bound, alone);
}

// What is left out may be hotter than weather makes it: the bound follows.
TEST(Influence, BoundsWhatIsHotter) {
  const HeatKit kit(yard_and_more(), kBudget);
  HeatSpec spec;
  spec.paths = 64;
  const ExchangePaths exchange = kit.exchange(path_options(spec));
  std::vector<bool> seen;
  for (size_t e = 0; e < kit.elements->size(); ++e) seen.push_back((*kit.elements)[e].material == 0);
  const Influence::Range near{std::vector<double>(exchange.faces(), 292), std::vector<double>(exchange.faces(), 292)};
  const Influence weather(exchange, *kit.faces, 450), engine(exchange, *kit.faces, 600);
  const std::vector<bool> kept = weather.kept_for(seen, 0.003, 292);
  const double by_weather = weather.off_at_most(seen, kept, near, {292, 292}),
               by_engine = engine.off_at_most(seen, kept, near, {292, 292});
  std::printf("%.5f K if nothing is warmer than 450 K, %.5f K if 600\n", by_weather, by_engine);
  EXPECT_LE(by_weather, 0.003);
  EXPECT_GT(by_engine, 3 * by_weather);  // 600^4 - 292^4 over 450^4 - 292^4 is 3.6
}

// What is seen is kept, whatever matters as much and has a lower number; and no bound holds where it is not. A small
// plate under a wide ceiling: by their areas the ceiling takes all that the plate gives.
TEST(Influence, WhatIsSeenIsKept) {
  HeatedScene s;
  const uint32_t ceiling = s.heated(0.9, heat()), plate = s.heated(0.9, heat());
  s.plane(10, 10, ceiling, with_axes({1, 0, 0}, {0, -1, 0}, {0, 0, 2}));
  s.plane(0.1, 0.1, plate);
  const HeatKit kit(std::move(s), 8);
  HeatSpec spec;
  spec.paths = 1024;
  const ExchangePaths exchange = kit.exchange(path_options(spec));
  const Influence influence(exchange, *kit.faces, 450);
  std::vector<bool> seen, others;
  for (size_t e = 0; e < kit.elements->size(); ++e) {
    seen.push_back((*kit.elements)[e].material == plate);
    others.push_back(!seen.back());
  }
  const auto count = std::count(seen.begin(), seen.end(), true);
  ASSERT_GT(count, 0);
  ASSERT_LT(std::find(seen.begin(), seen.end(), false), std::find(seen.begin(), seen.end(), true));
  for (const double limit : {0.01, 100.0, 1000.0}) {
    const std::vector<bool> kept = influence.kept_for(seen, limit, 290);
    for (size_t e = 0; e < seen.size(); ++e) EXPECT_TRUE(kept[e] || !seen[e]) << e << " for " << limit << " K";
  }
  const Influence::Range near{std::vector<double>(exchange.faces(), 290), std::vector<double>(exchange.faces(), 290)};
  EXPECT_EQ(influence.off_at_most(seen, others, near, {290, 290}), 450);
}

}  // namespace
}  // namespace suite::influence_test
