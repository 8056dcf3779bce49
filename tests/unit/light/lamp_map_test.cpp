// Maps of glowing surfaces: which pixel holds a place, in the scene's axes and on the Earth.
#include "light/lamp_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::test::lamp_map_test {
namespace {

// 3 columns, 2 rows: 0 1 2 / 3 4 5.
LampMap map_of(std::array<double, 6> to_map, std::optional<MapSystem> system = std::nullopt) {
  return {"m.tif", 3, 2, {0, 1, 2, 3, 4, 5}, to_map, system};
}

TEST(LampMap, PixelsInTheScene) {
  const PlacedLampMap map(std::make_shared<LampMap>(map_of({-15, 10, 0, 20, 0, -20})), std::nullopt);
  EXPECT_EQ(map.at({-14, 19, 7}), 0);
  EXPECT_EQ(map.at({0, 1, -7}), 1);
  EXPECT_EQ(map.at({14.9, 0.1, 0}), 2);
  EXPECT_EQ(map.at({-14.9, -0.1, 0}), 3);
  EXPECT_EQ(map.at({14.9, -19.9, 0}), 5);
  for (const Vec3 outside : {Vec3{-15.1, 0, 0}, {15.1, 0, 0}, {0, 20.1, 0}, {0, -20.1, 0}})
    EXPECT_EQ(map.at(outside), 0);
  // Wherever something glows the mean over a box is positive, however small the box; far off it is 0.
  Box3 box;
  box.grow(Vec3{14, -19, 0}), box.grow(Vec3{14.01, -18.99, 0});
  EXPECT_GT(map.mean_over(box), 0);
  Box3 far;
  far.grow(Vec3{500, 500, 0}), far.grow(Vec3{501, 501, 0});
  EXPECT_EQ(map.mean_over(far), 0);
}

// Pixels of 0.01 degrees; over the seam at 180 degrees as well. Negative control: a frame 0.01 degrees further east has
// the neighbour.
TEST(LampMap, PixelsOnTheEarth) {
  for (const double west : {8.0, 179.985}) {
    const auto map = std::make_shared<LampMap>(map_of({west, 0.01, 0, 50.01, 0, -0.01}, MapSystem{}));
    const SceneFrame frame({50.005, west + 0.015, 100}), east({50.005, west + 0.025, 100});
    EXPECT_EQ(PlacedLampMap(map, frame).at({0, 0, 0}), 1);
    EXPECT_EQ(PlacedLampMap(map, frame).at({0, 0, 3000}), 1);
    EXPECT_EQ(PlacedLampMap(map, frame).at({0, -1111, 0}), 4);  // 0.01 degrees are 1112 m
    EXPECT_EQ(PlacedLampMap(map, frame).at({-717, 0, 0}), 0);
    EXPECT_EQ(PlacedLampMap(map, frame).at({717, 0, 0}), 2);
    EXPECT_EQ(PlacedLampMap(map, east).at({0, 0, 0}), 2);
  }
}

}  // namespace
}  // namespace suite::test::lamp_map_test
