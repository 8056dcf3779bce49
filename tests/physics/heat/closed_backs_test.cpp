// Closed backs that are seen are told, unless only the ground under a body sees them.
#include <gtest/gtest.h>

#include "support/heated_scene_kit.h"

namespace suite::closed_backs_test {
namespace {

using namespace test;

// A house of four walls and a roof, 2 m wide, without a floor, on ground of 12 m; the roof is lifted by so much.
bool told(double lifted, double emissivity) {
  HeatedScene s;
  const uint32_t ground = s.heated(0.95, held_at(290)), wall = s.heated(emissivity, held_at(300));
  s.plane(12, 12, ground, shifted({0.37, 0.21, 0}));
  s.plane(2, 2, wall, with_axes({0, 1, 0}, {0, 0, 1}, {1, 0, 1}));
  s.plane(2, 2, wall, with_axes({0, -1, 0}, {0, 0, 1}, {-1, 0, 1}));
  s.plane(2, 2, wall, with_axes({-1, 0, 0}, {0, 0, 1}, {0, 1, 1}));
  s.plane(2, 2, wall, with_axes({1, 0, 0}, {0, 0, 1}, {0, -1, 1}));
  s.plane(2, 2, wall, shifted({0, 0, 2 + lifted}));
  const HeatKit kit(std::move(s), 60);
  HeatSpec spec;
  spec.span = {0, 86400}, spec.step = 3600, spec.paths = 256;
  StillWeather w;
  w.longwave = 300;
  for (const std::string& note : kit.solve(still_loads(w, spec.span, 24), spec).notes)
    if (note.find("closed backs are seen") != std::string::npos) return true;
  return false;
}

TEST(ClosedBacks, OfAHouseAreSeenByTheGroundUnderItAlone) {
  EXPECT_FALSE(told(0, 1));
  EXPECT_FALSE(told(0, 0.8));  // what the backs send back stays inside
}

// From beside the house under the roof: what the ground there sends into the gap.
TEST(ClosedBacks, UnderALiftedRoofAreTold) { EXPECT_TRUE(told(1, 1)); }

}  // namespace
}  // namespace suite::closed_backs_test
