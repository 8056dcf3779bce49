// Hulls of tiles hold all that rays can hit, and tell rays that pass by; heavy meshes of a cell are tiles of their own.
#include "trace/tile_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/sampling.h"
#include "motion/track.h"
#include "trace/tracer.h"

namespace suite::tile_hull_test {
namespace {

constexpr double kWindow = 2;  // s

// A wavy sheet of 2 * cells^2 triangles around its origin, cell m apart.
Mesh sheet(uint32_t cells, double cell, Vec3 origin) {
  Mesh m;
  m.name = "sheet";
  m.origin = origin;
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t j = 0; j <= cells; ++j)
    for (uint32_t i = 0; i <= cells; ++i) {
      const double x = cell * (i - 0.5 * cells), y = cell * (j - 0.5 * cells);
      for (const double c : {x, y, 4 * cell * std::sin(0.15 * i) * std::cos(0.1 * j + 1) + 0.1 * x})
        positions.push_back(static_cast<float>(c));
    }
  positions.push_back(0);
  for (uint32_t j = 0; j < cells; ++j)
    for (uint32_t i = 0; i < cells; ++i) {
      const uint32_t v = j * (cells + 1) + i;
      for (const uint32_t k : {v, v + 1, v + cells + 2, v, v + cells + 2, v + cells + 1}) indices.push_back(k);
    }
  m.positions = std::move(positions), m.indices = std::move(indices);
  m.parts = {{"", 0, static_cast<uint32_t>(m.triangle_count()), kNone}};
  return m;
}

Placement placed(TargetKind kind, uint32_t target, const Affine3& place, uint32_t track = kNone) {
  Placement p;
  p.kind = kind, p.target = target, p.to_parent = place, p.track = track;
  return p;
}

// A terrain as it is, one that is turned, a mesh that stands in many places, spheres, and a mesh that moves.
std::shared_ptr<const Scene> landscape() {
  auto s = std::make_shared<Scene>();
  s->meshes = {sheet(80, 20, {5e5, 4e6, 100}), sheet(60, 10, {}), sheet(4, 2, {}), sheet(20, 10, {})};
  s->primitives = {{"ball", PrimitiveKind::sphere, {20}, kNone}};
  s->tracks = {{"way", keyframe_track({{0, {quat_about({0, 0, 1}, 0.2), {5e5, 4e6, 400}}},
                                       {kWindow, {quat_about({0, 1, 0}, 0.5), {500600, 4000300, 450}}}})}};
  s->groups = {{"world", {}}, {"flies", {placed(TargetKind::mesh, 3, {})}}};
  auto& world = s->groups[0].placements;
  world.push_back(placed(TargetKind::mesh, 0, {}));
  world.push_back(placed(TargetKind::mesh, 1, translation({500200, 4000100, 300}) * rotation({1, 0, 0}, 0.4)));
  Pcg32 rng(1);
  for (int k = 0; k < 40; ++k)
    for (const TargetKind kind : {TargetKind::mesh, TargetKind::primitive}) {
      const Vec3 at{5e5 + 1500 * (rng.uniform() - 0.5), 4e6 + 1500 * (rng.uniform() - 0.5), 220 + 60 * rng.uniform()};
      world.push_back(placed(kind, kind == TargetKind::mesh ? 2 : 0, translation(at) * rotation({0, 1, 0}, k)));
    }
  world.push_back(placed(TargetKind::group, 1, {}, 0));
  s->bounds = scene_bounds(*s);
  return s;
}

bool within(const TileHull::Cell& cell, Vec3 p, double share) {
  for (size_t a = 0; a < 3; ++a) {
    const double middle = 0.5 * (double{cell.low[a]} + cell.high[a]), half = 0.5 * (double{cell.high[a]} - cell.low[a]);
    if (!(std::fabs(p[static_cast<int>(a)] - middle) <= share * half)) return false;
  }
  return true;
}

struct Held {
  size_t hits = 0, outside = 0, outside_shrunk = 0;  // of hits: in no cell; in none of those that are shrunk by 2 %
  size_t unmet = 0;                                  // of hits: of rays that are said to pass by
  size_t crossing = 0, passed_by = 0;                // rays that cross the tile's box and hit nothing; are said to
};

// Random rays through a scene of one tile, up to what they hit.
Held shoot(const Tracer& tracer) {
  const FlushDenormals flush;
  Held held;
  Pcg32 rng(7);
  const auto somewhere = [&] {
    const Vec3 size = tracer.bounds().size();
    return tracer.bounds().low + Vec3{size.x * rng.uniform(), size.y * rng.uniform(), size.z * rng.uniform()};
  };
  TraceStatistics statistics;
  for (int k = 0; k < 40000; ++k) {
    const Vec3 through = somewhere();
    const Dir along = normalized(somewhere() - through);
    const Ray ray{through - along * 5000.0, along, kWindow * rng.uniform()};
    Hit hit;
    tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
    const std::vector<const TileHull*> hulls = hulls_of(tracer);
    if (hulls.size() != 1) continue;
    const TileHull& hull = *hulls[0];
    if (!hit.hit()) ++held.crossing, held.passed_by += !hull.meets(ray, INFINITY);
    if (!hit.hit()) continue;
    ++held.hits;
    held.unmet += !hull.meets(ray, hit.distance);
    const auto in = [&](double share) {
      const auto cells = hull.cells();
      return std::any_of(cells.begin(), cells.end(), [&](const TileHull::Cell& cell) {
        return !cell.empty() && within(cell, hit.position - hull.origin(), share);
      });
    };
    held.outside += !in(1);
    held.outside_shrunk += !in(0.98);
  }
  return held;
}

TEST(TileHull, HoldsAllThatRaysHit) {
  auto still = std::make_shared<Scene>(*landscape());
  still->groups[0].placements.pop_back();  // what moves
  const Tracer tracer(still, std::nullopt, {}, nullptr, {SIZE_MAX, {}});
  EXPECT_TRUE(hulls_of(tracer).empty());  // nothing was built
  const Held held = shoot(tracer);
  EXPECT_GT(held.hits, 5000u);
  EXPECT_EQ(held.outside, 0u);
  EXPECT_EQ(held.unmet, 0u);
  EXPECT_GT(held.outside_shrunk, held.hits / 100);
  EXPECT_GT(held.crossing, 5000u);
  EXPECT_GT(held.passed_by, held.crossing / 2);
}

TEST(TileHull, HoldsWhatMovesAtAllTimes) {
  auto alone = std::make_shared<Scene>(*landscape());
  alone->groups[0].placements = {alone->groups[0].placements.back()};
  const Held held = shoot(Tracer(alone, std::nullopt, {0, kWindow}, nullptr, {SIZE_MAX, {}}));
  EXPECT_GT(held.hits, 300u);
  EXPECT_EQ(held.outside, 0u);
  EXPECT_EQ(held.unmet, 0u);
}

TEST(TileHull, IsNotMadeWithoutALimit) {
  auto still = std::make_shared<Scene>(*landscape());
  still->groups[0].placements.pop_back();
  const Tracer tracer(still);
  EXPECT_EQ(shoot(tracer).hits, 0u);  // of tiles with a hull
  EXPECT_EQ(tracer.tiles_built(), 1u);
}

// Two sheets in one cell of the grid of tiles and one far off: of many triangles each is a tile, of few a cell is.
TEST(Tiles, HeavyMeshesOfACellAreTilesOfTheirOwn) {
  for (const auto& [cells, tiles] : {std::pair{46u, 3u}, {10u, 2u}}) {
    auto s = std::make_shared<Scene>();
    s->groups = {{"world", {}}};
    for (const double x : {0.0, 700.0, 9000.0}) {
      s->groups[0].placements.push_back(placed(TargetKind::mesh, static_cast<uint32_t>(s->meshes.size()), {}));
      s->meshes.push_back(sheet(cells, 500.0 / cells, {x, 0, 0}));
    }
    const auto stone = static_cast<uint32_t>(s->meshes.size());
    s->meshes.push_back(sheet(4, 1, {}));
    for (const double x : {10.0, 600.0})
      s->groups[0].placements.push_back(placed(TargetKind::mesh, stone, translation({x, 0, 90})));
    s->bounds = scene_bounds(*s);
    EXPECT_EQ(Tracer(s).tiles(), tiles);
  }
}

}  // namespace
}  // namespace suite::tile_hull_test
