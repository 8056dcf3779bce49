// Lookup tables from places to pixels: what lies in a cell is found, gaps are filled and marked, tears are not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sensor/ground_grid.h"
#include "support/message_of.h"

namespace suite::ground_grid_test {
namespace {

// A picture of columns x rows whose pixels lie `step` apart, turned by an angle.
std::vector<Vec2> turned(uint32_t columns, uint32_t rows, double step, double angle) {
  std::vector<Vec2> places;
  for (uint32_t r = 0; r < rows; ++r)
    for (uint32_t c = 0; c < columns; ++c)
      places.push_back({1000.03 + step * (c * std::cos(angle) + r * std::sin(angle)),
                        1999.97 + step * (c * std::sin(angle) - r * std::cos(angle))});
  return places;
}
Vec2 middle(const GroundGrid& g, size_t cell) {
  return {g.west + (static_cast<double>(cell % g.columns) + 0.5) * g.cell,
          g.north - (static_cast<double>(cell / g.columns) + 0.5) * g.cell};
}
double far(Vec2 a, Vec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(GroundGrid, EveryCellHasTheNearestPixelAndSaysWhetherItLiesInIt) {
  for (const double cell : {0.4, 1.0, 2.3}) {
    const std::vector<Vec2> places = turned(30, 20, 1, 0.4);
    const auto g = ground_grid(places, 30, cell);
    ASSERT_TRUE(g);
    size_t direct = 0, filled = 0, empty = 0;
    for (size_t i = 0; i < g->sample.size(); ++i) {
      if (!g->sample[i]) {
        ++empty;
        EXPECT_EQ(g->line[i], 0);
        continue;
      }
      (g->sample[i] > 0 ? direct : filled)++;
      ASSERT_EQ(g->sample[i] > 0, g->line[i] > 0);
      const Vec2 at = middle(*g, i);
      const size_t pixel =
          static_cast<size_t>(std::abs(g->line[i]) - 1) * 30 + static_cast<size_t>(std::abs(g->sample[i]) - 1);
      ASSERT_LT(pixel, places.size());
      // A pixel in the cell is preferred to a nearer one beside it.
      double nearest = 1e9, nearest_inside = 1e9;
      for (const Vec2 p : places) {
        nearest = std::min(nearest, far(p, at));
        if (std::max(std::fabs(p.x - at.x), std::fabs(p.y - at.y)) < cell / 2)
          nearest_inside = std::min(nearest_inside, far(p, at));
      }
      EXPECT_EQ(g->sample[i] > 0, nearest_inside < 1e9) << cell;
      EXPECT_NEAR(far(places[pixel], at), nearest_inside < 1e9 ? nearest_inside : nearest, 1e-4);
    }
    EXPECT_GT(direct, 0u);
    EXPECT_GT(empty, 0u);
    EXPECT_EQ(filled > direct, cell < 1) << cell;
  }
}

// A row of places that is missing, and a cliff: the first is spanned by nothing, the second is too far apart.
TEST(GroundGrid, UnknownPlacesAndTearsStayEmpty) {
  std::vector<Vec2> places = turned(20, 20, 1, 0);
  for (size_t i = 0; i < places.size(); ++i) {
    if (i / 20 >= 10) places[i].y -= 30;  // a cliff after line 10
    if (i % 20 == 5) places[i] = {NAN, NAN};
  }
  const auto g = ground_grid(places, 20, 0.5);
  ASSERT_TRUE(g);
  size_t hidden = 0, missing = 0;
  for (size_t i = 0; i < g->sample.size(); ++i) {
    const Vec2 at = middle(*g, i);
    const double below = 2000 - at.y;
    const bool in_cliff = below > 10 && below<38, in_gap = at.x> 1004.6 && at.x < 1005.4 && below > 0.6 && below < 8.6;
    if (in_cliff || in_gap) {
      EXPECT_EQ(g->sample[i], 0) << at.x << " " << at.y;
    }
    hidden += in_cliff, missing += in_gap;
  }
  EXPECT_GT(hidden, 500u);
  EXPECT_GT(missing, 10u);
}

TEST(GroundGrid, SpacingDecidesTheCell) {
  EXPECT_NEAR(spacing_of(turned(30, 20, 0.731, 0.3), 30).pixel(), 0.73, 1e-12);
  EXPECT_NEAR(spacing_of(turned(1, 20, 27.4, 0), 1).pixel(), 27, 1e-12);
  EXPECT_EQ(spacing_of(std::vector<Vec2>{{1, 2}}, 1).pixel(), 0);
}

TEST(GroundGrid, NothingKnownAndTooManyCells) {
  EXPECT_FALSE(ground_grid(std::vector<Vec2>(6, {NAN, NAN}), 3, 1));
  const std::string text = message_of([] { ground_grid(std::vector<Vec2>{{0, 0}, {1e6, 1e6}}, 2, 0.5); });
  EXPECT_NE(text.find("a lookup table of 2e+06 x 2e+06 cells of 0.5 is too large"), std::string::npos) << text;
  EXPECT_NE(text.find("pixel_m: 86"), std::string::npos) << text;
}

}  // namespace
}  // namespace suite::ground_grid_test
