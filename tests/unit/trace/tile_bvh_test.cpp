// The order in which a ray meets tiles: all of them, by where it enters them, however they overlap. A walk depth first
// once met far tiles first, and the tracer, which stops at the first tile beyond a hit, then missed near ones.
#include "trace/tile_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/sampling.h"

namespace suite::tile_bvh_test {
namespace {

struct Boxes {
  std::vector<Box3> boxes;
  TileBvh bvh;
  std::vector<TileBvh::Entry> open;
  Pcg32 rng{5};
  Vec3 point(double size) { return Vec3{rng.uniform(), rng.uniform(), 0.1 * rng.uniform()} * size; }
  explicit Boxes(size_t count, double widest) {
    for (size_t i = 0; i < count; ++i) {
      Box3 b;
      const Vec3 low = point(100);
      b.grow(low);
      b.grow(low + point(widest));
      boxes.push_back(b);
    }
    bvh.build(boxes);
  }
};

TEST(TileBvh, VisitsAllTilesInTheOrderOfTheRay) {
  size_t visited = 0;
  for (const double widest : {5.0, 60.0}) {
    Boxes all(200, widest);
    for (int i = 0; i < 500; ++i) {
      const Vec3 from = all.point(100);
      const Ray ray{from, normalized(all.point(100) - from), 0};
      std::vector<std::pair<double, uint32_t>> wanted, found;
      double enter = 0, leave = 0, t_max = INFINITY;
      for (uint32_t b = 0; b < all.boxes.size(); ++b)
        if (clip(all.boxes[b], ray.origin, inverse_of(ray.direction), t_max, enter, leave))
          wanted.emplace_back(enter, b);
      std::sort(wanted.begin(), wanted.end());
      all.bvh.walk(ray, t_max, all.open, [&](uint32_t tile, double at) { found.emplace_back(at, tile); });
      EXPECT_EQ(found, wanted);
      visited += found.size();
    }
  }
  EXPECT_GT(visited, 5000u);
}

TEST(TileBvh, StopsWhereItIsTold) {
  Boxes all(200, 60);
  for (int i = 0; i < 100; ++i) {
    const Vec3 from = all.point(100);
    const Ray ray{from, normalized(all.point(100) - from), 0};
    double t_max = INFINITY, stop = 10;
    all.bvh.walk(ray, t_max, all.open, [&](uint32_t, double at) {
      EXPECT_LE(at, t_max);
      if (at >= stop) t_max = stop;
    });
  }
}

}  // namespace
}  // namespace suite::tile_bvh_test
