// Things that are there for a part of the span: what is told of the infrared that is spread over all of it.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "support/heated_scene_kit.h"

namespace suite::visitors_test {
namespace {

using namespace test;

// A black plate held at 350 K half its side above one of 300 K, which sees 0.41525 of it (e.g. Siegel & Howell, Thermal
// radiation heat transfer, appendix C), under a sky that emits 200 W/m2.
HeatResult solved(TimeSpan life) {
  HeatedScene s;
  s.plane(1, 1, s.heated(1, held_at(300)));
  s.plane(1, 1, s.heated(1, held_at(350)), upside_down({0, 0, 0.5}));
  s.there(life);
  const HeatKit kit(std::move(s), 2);
  HeatSpec spec;
  spec.span = {0, 86400}, spec.step = 3600, spec.paths = 2048;
  StillWeather w;
  w.longwave = 200;
  return kit.solve(still_loads(w, spec.span, 24), spec);
}

std::optional<double> told(const HeatResult& r) {
  for (const std::string& sentence : r.notes)
    if (const size_t at = sentence.find("evenly; that is "); at != std::string::npos)
      return std::stod(sentence.substr(at + 16));
  return std::nullopt;
}

TEST(Visitors, WhatIsSpreadOverTheSpanIsTold) {
  const HeatResult r = solved({21600, 64800});
  const std::optional<double> half = told(r);
  ASSERT_TRUE(half);
  // Received in place of the plate: what all others send, the plate's half included.
  const double share = 0.41525 / 2, received = double{r.received[0]}, exact = share * (black(350) - received);
  std::printf("a plate over another for half the time: %.2f W/m2 told, %.2f\n", *half, exact);
  EXPECT_NEAR(*half, exact, 0.06 * exact);
  EXPECT_GT(exact, 50);
  // What paths from the plate say of those below is for its share, too: they start at all times, as if it were there.
  const double all = share * black(350) + (1 - share) * 200;
  std::printf("received below it: %.2f W/m2, %.2f\n", received, all);
  EXPECT_NEAR(received, all, 0.02 * all);
  EXPECT_FALSE(told(solved(kAlways)));  // negative control
}

}  // namespace
}  // namespace suite::visitors_test
