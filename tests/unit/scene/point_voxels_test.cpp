// Leaf area of scanned points: a canopy of known density, seen from straight above, comes back.
#include "scene/point_voxels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "support/message_of.h"

namespace suite::point_voxels_test {
namespace {

// Beams from above meet leaves by chance (Beer's law with a projection of 1/2), else the ground.
struct Scan {
  std::vector<Vec3> places;
  std::vector<bool> leaf;
};
Scan scan(const std::vector<double>& density, int beams) {
  Scan made;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < beams; ++k) {
    const double x = 2 * uniform(random), y = 2 * uniform(random);
    double left = -std::log(1 - uniform(random)) / 0.5;  // leaf area that is passed before one is met
    bool met = false;
    for (size_t layer = density.size(); layer-- > 0 && !met;) {
      if (left < density[layer]) {
        made.places.push_back({x, y, static_cast<double>(layer + 1) - left / density[layer]});
        made.leaf.push_back(met = true);
      } else {
        left -= density[layer];
      }
    }
    if (!met) made.places.push_back({x, y, -0.01}), made.leaf.push_back(false);
  }
  return made;
}

TEST(PointVoxels, LeafAreaComesBack) {
  const std::vector<double> density{0.4, 0.8, 1.2, 0.2};
  const Scan s = scan(density, 400000);
  const PointVoxels v = point_voxels(s.places, s.leaf, 1, PointRule::leaf_area, 0.5);
  ASSERT_EQ(v.cells, (std::array<uint32_t, 3>{2, 2, 4}));
  EXPECT_EQ(v.opaque, size_t{0});
  // Of some 40 000 beams a cell: standard errors below 0.02; five of them.
  for (size_t cell = 0; cell < v.density.size(); ++cell) EXPECT_NEAR(v.density[cell], density[cell / 4], 0.1) << cell;
  EXPECT_EQ(v.to_local.point({0, 0, 0}), (Vec3{0, 0, 0}));
  // And what is wrong by a factor of two is seen.
  EXPECT_GT(std::fabs(point_voxels(s.places, s.leaf, 1, PointRule::leaf_area, 1).density[8] - 1.2), 0.4);
}

TEST(PointVoxels, Counts) {
  const Scan s = scan({1}, 1000);
  const PointVoxels v = point_voxels(s.places, s.leaf, 2, PointRule::counts, 0.5);
  size_t leaves = 0;
  for (const bool l : s.leaf) leaves += l;
  double sum = 0;
  for (const float d : v.density) sum += d * 8;
  EXPECT_NEAR(sum, static_cast<double>(leaves), 1e-3);
}

TEST(PointVoxels, CellsWithoutLightAreCounted) {
  const PointVoxels v =
      point_voxels(std::vector<Vec3>{{0.5, 0.5, 0.5}, {0.5, 0.5, 1.5}}, {true, true}, 1, PointRule::leaf_area, 0.5);
  EXPECT_EQ(v.opaque, size_t{1});
  EXPECT_NEAR(v.density[0], 2 * std::log(3), 1e-6);  // half a beam of one and a half comes through
  EXPECT_NEAR(v.density[1], 2 * std::log(2), 1e-6);
}

TEST(PointVoxels, FarPointsAreNoHugeGrid) {
  EXPECT_NE(message_of([] {
              point_voxels(std::vector<Vec3>{{0, 0, 0}, {1e6, 1e6, 10}}, {true, true}, 0.1, PointRule::counts, 0.5);
            }),
            "no error");
  EXPECT_NE(message_of([] {
              point_voxels(std::vector<Vec3>{{0, 0, 0}}, {false}, 1, PointRule::counts, 0.5);
            }),
            "no error");
}

}  // namespace
}  // namespace suite::point_voxels_test
