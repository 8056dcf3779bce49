// Pixels shared out among cells: areas add up, what is seen from above covers what is seen beneath it.
#include "sensor/footprints.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::footprints_test {
namespace {

struct Turned {
  uint32_t columns = 40, rows = 30;
  double step;
  std::vector<Vec2> places;
  explicit Turned(double pixel) : step(pixel) {
    const double c = std::cos(0.4) * pixel, s = std::sin(0.4) * pixel;
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x) places.push_back({500 + c * x + s * y, 700 + s * x - c * y});
  }
};

// Every pixel well inside gives its whole area to the cells, however large these are, and a cell is full.
TEST(Footprints, AreasAddUp) {
  for (const double cell : {0.3, 1.0, 2.5}) {
    const Turned t(1);
    const auto grid = ground_grid(t.places, t.columns, cell);
    const Footprints f(t.places, std::vector<double>(t.places.size(), 7), t.columns, *grid, 1);
    std::vector<double> given(t.places.size());
    for (size_t i = 0; i < grid->sample.size(); ++i) {
      double seen = 0;
      for (const auto& s : f.cell(i)) given[s.pixel] += s.area * cell * cell, seen += s.area;
      EXPECT_LT(seen, 1 + 1e-4);
      EXPECT_TRUE(f.cell(i).empty() || seen >= 0.5) << seen;
    }
    for (uint32_t y = 5; y < 25; ++y)
      for (uint32_t x = 5; x < 35; ++x) ASSERT_NEAR(given[y * t.columns + x], 1, 2e-3) << cell;
  }
}

// A plane in the values is a plane on the map: the mean over a cell is its value at the middle.
TEST(Footprints, APlaneStaysOne) {
  const Turned t(0.2);
  const auto grid = ground_grid(t.places, t.columns, 1);
  const Footprints f(t.places, std::vector<double>(t.places.size(), 0), t.columns, *grid, 1);
  size_t full = 0;
  for (size_t i = 0; i < grid->sample.size(); ++i) {
    double x = 0, y = 0, seen = 0;
    for (const auto& s : f.cell(i))
      x += s.area * t.places[s.pixel].x, y += s.area * t.places[s.pixel].y, seen += s.area;
    if (seen < 0.9999) continue;
    ++full;
    EXPECT_NEAR(x / seen, grid->west + static_cast<double>(i % grid->columns) + 0.5, 0.02);
    EXPECT_NEAR(y / seen, grid->north - static_cast<double>(i / grid->columns) - 0.5, 0.02);
  }
  EXPECT_GT(full, 15u);
}

// A deck 10 m above the ground: beside it the ground, and where both are seen the deck. Its edge is torn, not
// stretched.
TEST(Footprints, TheUpperLayerCounts) {
  std::vector<Vec2> places;
  std::vector<double> heights;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool deck = x >= 20;
      places.push_back({deck ? x - 30.0 : x, -1.0 * y});  // the deck lies over ground that columns 0 to 9 show
      heights.push_back(deck ? 10 : 0);
    }
  const auto grid = ground_grid(places, 40, 1);
  const Footprints f(places, heights, 40, *grid, 1);
  size_t ground = 0, deck = 0;
  for (size_t i = 0; i < grid->sample.size(); ++i) {
    const double x = grid->west + static_cast<double>(i % grid->columns) + 0.5;
    for (const auto& s : f.cell(i)) {
      const bool above = heights[s.pixel] > 5;
      EXPECT_EQ(above, x < 9.6) << x;
      (above ? deck : ground)++;
    }
  }
  EXPECT_GT(deck, 100u);
  EXPECT_GT(ground, 100u);
}

}  // namespace
}  // namespace suite::footprints_test
