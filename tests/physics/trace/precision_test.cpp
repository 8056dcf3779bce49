// Precision at sensor distance: cameras from a metre to 36 000 km, geometry up to an Earth radius from the origin.
// A convex dome cannot shadow itself, so every blocked sun ray is a false one; every ray aimed inside it must hit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>

#include "math/sampling.h"
#include "tests/support/radiometry_kit.h"
#include "trace/tracer.h"

namespace suite::test::precision_test {
namespace {

struct Setting {
  const char* name;
  double distance;  // of the camera, m
  Vec3 centre;      // of the dome, ENU
  double width;     // m
};

class Precision : public testing::TestWithParam<Setting> {};

TEST_P(Precision, NothingMissedNothingFalselyShadowed) {
  const Setting& s = GetParam();
  auto scene = scene_of({dome(s.width)}, {material("m", lambert(0.5))});
  scene->groups[0].placements[0].to_parent = translation(s.centre);
  const Tracer tracer(scene);
  const Dir up = normalized(Vec3{0.2, 0.1, 1});
  const Vec3 camera = s.centre + up * s.distance;
  const Dir sun = normalized(Vec3{0.4, -0.3, 0.8});
  constexpr size_t count = 20000;
  std::vector<Ray> rays;
  Pcg32 rng(7);
  for (size_t i = 0; i < count; ++i) {
    const double x = (rng.uniform() - 0.5) * 0.98 * s.width, y = (rng.uniform() - 0.5) * 0.98 * s.width;
    const Vec3 target = s.centre + Vec3{x, y, -(x * x + y * y) / (10 * s.width)};
    rays.push_back({camera, normalized(target - camera), 0});
  }
  std::vector<Hit> hits(count);
  TraceStatistics statistics;
  tracer.nearest(rays, hits, true, statistics);
  size_t missed = 0;
  std::vector<double> errors;
  std::vector<Ray> sun_rays;
  for (size_t i = 0; i < count; ++i) {
    if (!hits[i].hit()) {
      ++missed;
      continue;
    }
    // Distance of the reported point from the line of sight, in double.
    const Vec3 offset = hits[i].position - rays[i].origin;
    errors.push_back(length(offset - rays[i].direction * dot(offset, rays[i].direction)));
    sun_rays.push_back({tracer.leave(hits[i], sun), sun, 0});
  }
  std::vector<uint8_t> blocked(sun_rays.size());
  const std::vector<double> far(sun_rays.size(), INFINITY);
  tracer.occluded(sun_rays, far, blocked, false, statistics);
  EXPECT_EQ(missed, 0u);
  EXPECT_EQ(std::count(blocked.begin(), blocked.end(), 1), 0);
  std::sort(errors.begin(), errors.end());
  const double p99 = errors.at(errors.size() * 99 / 100), half = s.width / 2;
  const double ulp = std::nextafter(static_cast<float>(half), INFINITY) - static_cast<float>(half);
  // Double itself cannot say where a line of sight from far away is to better than this.
  const double double_limit = 4 * DBL_EPSILON * (s.distance + length(s.centre));
  EXPECT_LE(p99, 2 * ulp + double_limit);
  std::printf("%zu rays: %zu missed, %ld falsely shadowed, hit error p99 %.2f ulp of the half size\n", count, missed,
              static_cast<long>(std::count(blocked.begin(), blocked.end(), 1)), p99 / ulp);
}

constexpr double kEarth = 6.378e6;
INSTANTIATE_TEST_SUITE_P(Table, Precision,
                         testing::Values(Setting{"camera_1m_scene_1mm", 1, {0, 0, 0}, 1e-3},
                                         Setting{"camera_2km", 2e3, {0, 0, 0}, 1000},
                                         Setting{"camera_700km", 7e5, {0, 0, 0}, 1000},
                                         Setting{"camera_36000km", 3.6e7, {0, 0, 0}, 1000},
                                         Setting{"geometry_1000km_away", 7e5, {1e6, 2e5, 0}, 1000},
                                         Setting{"earth_centred", 7e5, {kEarth * 0.6, 0, kEarth * 0.8}, 1000},
                                         Setting{"tile_4km", 7e5, {0, 0, 0}, 4000}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(Precision, ManyTilesOverAThousandKilometres) {
  // Domes every 50 km on a line of 1000 km: as many tiles, each ray finds its own.
  auto scene = scene_of({dome(1000)}, {material("m", lambert(0.5))});
  scene->groups[0].placements.clear();
  for (int i = 0; i < 20; ++i) {
    Placement p;
    p.to_parent = translation({i * 5e4, 0, 0});
    scene->groups[0].placements.push_back(p);
  }
  const Tracer tracer(scene);
  EXPECT_EQ(tracer.tiles(), 20u);
  TraceStatistics statistics;
  for (int i = 0; i < 20; ++i) {
    const Ray ray{{i * 5e4 + 3, 4, 7e5}, {0, 0, -1}, 0};
    Hit hit;
    tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
    ASSERT_TRUE(hit.hit()) << i;
    EXPECT_EQ(tracer.object(hit.object).instance, static_cast<uint32_t>(i));
    EXPECT_NEAR(hit.position.x, i * 5e4 + 3, 1e-4);
  }
  // A grazing ray passes over all of them and meets the last when aimed at it.
  const Ray along{{-1000, 0, 200}, normalized(Vec3{19 * 5e4 + 1000, 0, -205}), 0};
  Hit hit;
  tracer.nearest({&along, 1}, {&hit, 1}, false, statistics);
  ASSERT_TRUE(hit.hit());
}

TEST(Instancing, NestedSixtyFourDeepAgreesWithDoubleReference) {
  // Every level turns, moves and mirrors a little; the flattened transform is the product in double.
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("m", lambert(0.5))};
  scene->meshes = {quad(1, 0, 0)};
  Affine3 product;
  for (uint32_t level = 0; level < 64; ++level) {
    Group g;
    Placement p;
    const double scale = level % 2 ? 1.25 : 0.8;
    p.to_parent = translation({0.3, -0.2, 0.1}) * rotation(normalized(Vec3{1, 2, 3}), 0.3) *
                  scaling({level % 8 == 0 ? -scale : scale, scale, scale});
    p.kind = level < 63 ? TargetKind::group : TargetKind::mesh;
    p.target = level < 63 ? level + 1 : 0;
    product = product * p.to_parent;
    g.placements.push_back(p);
    scene->groups.push_back(g);
  }
  check_scene(*scene, "nested");
  const Tracer tracer(scene);
  ASSERT_EQ(tracer.object_count(), 1u);
  const Vec3 centre = product.point({0.1, 0.2, 0}), normal = normalized(product.normal({0, 0, 1}));
  const Ray ray{centre + normal * 5.0, -normal, 0};
  Hit hit;
  TraceStatistics statistics;
  tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
  ASSERT_TRUE(hit.hit());
  EXPECT_LT(length(hit.position - centre), 1e-6);
  EXPECT_LT(length(hit.normal - normal), 1e-9);
}

// Coherent packets once missed a sheet in the upper face of a tile, because their rays began within an ulp of it.
TEST(Precision, CoherentPacketsMissNoSheetWhereTheyBegin) {
  auto scene = scene_of({quad(10, 4, 0), quad(10, 0, 0)}, {material("m", lambert(0.5))});
  scene->groups[0].placements[1].to_parent = translation({0, 0, 6});
  scene->groups[0].placements.push_back(scene->groups[0].placements[1]);
  scene->groups[0].placements[2].to_parent = translation({0, 0, 7}) * rotation({0, 0, 1}, 0.5);
  const Tracer tracer(scene);
  const FlushDenormals flush;
  TraceStatistics statistics;
  Pcg32 random(9);
  std::vector<Ray> rays;
  for (int i = 0; i < 4000; ++i)
    rays.push_back({{12 * random.uniform() - 6, 12 * random.uniform() - 6, 20},
                    normalized(Vec3{0.1 * random.uniform(), 0.1 * random.uniform(), -1}),
                    0});
  std::vector<Hit> hits(rays.size());
  for (const bool coherent : {true, false}) {
    tracer.nearest(rays, hits, coherent, statistics);
    EXPECT_EQ(std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.object != 2; }), 0) << coherent;
  }
}

}  // namespace
}  // namespace suite::test::precision_test
