// Cut-outs: the answer is a function of ray and surface, whatever is asked in whatever order; the share of rays stopped
// is the opacity; nearest hits and visibility agree; instances, exact surfaces and unbounded planes have holes too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "surface/cut_out.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::cut_out_test {
namespace {

PropertyMap opacity(std::vector<float> values, uint32_t width, Projection projection) {
  PropertyMap m;
  m.name = "holes";
  m.kind = MapKind::opacity;
  m.width = width;
  m.height = static_cast<uint32_t>(values.size()) / width;
  m.values = std::move(values);
  m.projection = projection;
  m.drape = {-10, 10, 20.0 / m.width, 20.0 / m.height, Drape::Extend::repeat};
  return m;
}

// Five sheets one above the other, each with holes: meshes alone, an instanced one, a bounded plane, a disk, and an
// unbounded plane at the bottom.
std::shared_ptr<Scene> sheets(const PropertyMap& map) {
  auto s = std::make_shared<Scene>();
  s->materials = {material("m", lambert(0.5)), material("whole", lambert(0.1))};
  s->property_maps = {map};
  s->property_bindings = {{0, 0}};
  Mesh lone = quad(10, 4, 0), shared = quad(10, 0, 0);
  for (Mesh* m : {&lone, &shared}) m->uvs = {0, 0, 1, 0, 1, 1, 0, 1};
  s->meshes = {lone, shared};
  s->primitives = {{"plane", PrimitiveKind::plane, {20, 20}, 0},
                   {"ball", PrimitiveKind::sphere, {9}, 0},
                   {"ground", PrimitiveKind::plane, {0, 0}, 0}};
  Group root{"root", {}};
  const auto place = [&](TargetKind kind, uint32_t target, Affine3 at) {
    Placement p;
    p.kind = kind, p.target = target, p.to_parent = at;
    root.placements.push_back(p);
  };
  place(TargetKind::mesh, 0, {});
  place(TargetKind::mesh, 1, translation({0, 0, 6}));
  place(TargetKind::mesh, 1, translation({0, 0, 7}) * rotation({0, 0, 1}, 0.5));
  place(TargetKind::primitive, 0, translation({0, 0, 2}));
  place(TargetKind::primitive, 1, translation({0, 0, -15}));
  place(TargetKind::primitive, 2, translation({0, 0, -30}));
  s->groups = {root};
  check_scene(*s, "sheets");
  return s;
}

std::vector<Ray> rays_down(size_t n) {
  std::mt19937 random(9);
  const auto u = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<Ray> rays;
  for (size_t i = 0; i < n; ++i)
    rays.push_back(
        {{12 * u() - 6, 12 * u() - 6, 20}, normalized(Vec3{0.1 * u(), 0.1 * u(), -1}), 0, static_cast<uint32_t>(i)});
  return rays;
}

TEST(CutOut, NoOrderOfAskingShows) {
  for (const Projection projection : {Projection::drape, Projection::uv}) {
    const auto scene = sheets(opacity({0.2f, 0.9f, 0.5f, 0, 1, 0.3f}, 3, projection));
    const Tracer tracer(scene, std::nullopt, {}, cut_out(*scene));
    const FlushDenormals flush;
    TraceStatistics statistics;
    const std::vector<Ray> rays = rays_down(4000);
    std::vector<Hit> hits(rays.size());
    tracer.nearest(rays, hits, true, statistics);
    // In another order, which packs other rays together, and one by one.
    std::vector<size_t> order(rays.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    std::vector<Ray> shuffled;
    for (const size_t i : order) shuffled.push_back(rays[i]);
    std::vector<Hit> again(rays.size());
    tracer.nearest(shuffled, again, false, statistics);
    std::vector<uint32_t> seen;
    for (size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(again[i].object, hits[order[i]].object);
      EXPECT_EQ(again[i].position.z, hits[order[i]].position.z);
      Hit alone;
      tracer.nearest(std::span(&rays[i], 1), std::span(&alone, 1), false, statistics);
      EXPECT_EQ(alone.object, hits[i].object) << i;
      if (hits[i].hit()) seen.push_back(hits[i].object);
    }
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    EXPECT_EQ(seen.size(), 6u);  // every sheet stops some

    // Visibility agrees: nothing lies before the hit, something lies within a little more.
    std::vector<double> before, behind;
    for (const Hit& h : hits)
      before.push_back(h.hit() ? h.distance - 1e-3 : INFINITY),
          behind.push_back(h.hit() ? h.distance + 1e-3 : INFINITY);
    std::vector<uint8_t> blocked(rays.size());
    tracer.occluded(rays, before, blocked, false, statistics);
    EXPECT_EQ(std::count(blocked.begin(), blocked.end(), 1), 0);
    tracer.occluded(rays, behind, blocked, false, statistics);
    for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(blocked[i] == 1, hits[i].hit()) << i;
  }
}

TEST(CutOut, TheShareOfRaysStoppedIsTheOpacity) {
  const auto scene = sheets(opacity({0.3f}, 1, Projection::drape));
  const Tracer tracer(scene, std::nullopt, {}, cut_out(*scene));
  const FlushDenormals flush;
  TraceStatistics statistics;
  // One ray, many draws; and many rays, one draw. (Rays through the common edge of two triangles meet both.)
  std::vector<Ray> rays(40000, Ray{{0.1, 0.037, 20}, {0, 0, -1}, 0, 0});
  for (size_t i = 0; i < rays.size() / 2; ++i) rays[i].draw = static_cast<uint32_t>(i);
  for (size_t i = rays.size() / 2; i < rays.size(); ++i)
    rays[i].origin.x = 1e-4 * static_cast<double>(i % 1000), rays[i].origin.y = 1e-5 * static_cast<double>(i);
  std::vector<Hit> hits(rays.size());
  tracer.nearest(rays, hits, true, statistics);
  for (int half = 0; half < 2; ++half) {
    const auto from = hits.begin() + half * 20000, to = from + 20000;
    // The sheets from above: each stops 30 % of what reaches it. The ball has two sides.
    double left = 20000;
    for (const uint32_t object : {2u, 1u, 0u, 3u}) {
      const auto n = static_cast<double>(std::count_if(from, to, [&](const Hit& h) { return h.object == object; }));
      EXPECT_NEAR(n, 0.3 * left, 5 * std::sqrt(0.21 * left)) << object;  // 5 sigma
      left -= n;
    }
    const auto ball = static_cast<double>(std::count_if(from, to, [&](const Hit& h) { return h.object == 4; }));
    EXPECT_NEAR(ball, 0.51 * left, 5 * std::sqrt(0.25 * left));
  }
}

TEST(CutOut, ShadowsAreAsDeepAsTheOpacity) {
  // A sheet of opacity 0.4 over a Lambert ground, sun straight above: the ground under it has 60 % of the light.
  auto scene = std::make_shared<Scene>();
  scene->materials = {material("ground", lambert(0.5)), material("sheet", lambert(0))};
  scene->meshes = {quad(10, 0, 0), quad(10, 1, 1)};
  scene->groups = {{"root", {Placement{}, Placement{}}}};
  scene->groups[0].placements[1].target = 1;
  scene->property_maps = {opacity({0.4f}, 1, Projection::drape)};
  scene->property_bindings = {{1, 0}};
  SourceSpecs sources;
  sources.add(SunSpec{{{0, 0, 1}, 0, Curve::constant(kPi)}});
  // Seen from below the sheet, so only the sun's ray passes it; the same ray for all paths.
  const Dir out = dir_from_angles(1.2, 0.3);
  const auto run = render(
      scene, sources,
      std::make_unique<RaySensor>(std::vector<Ray>{{out * 0.5 + Vec3{0.1, 0.037, 0}, -out, 0}}, one_band(), 1 << 14));
  EXPECT_NEAR(run.result.radiance[0], 0.6 * 0.5, 5 * run.result.standard_error[0]);
  EXPECT_LT(run.result.standard_error[0], 0.01);
}

TEST(CutOut, WholeScenesAskNobody) {
  const auto scene = scene_of({quad(1, 0, 0)}, {material("m", lambert(0.5))});
  EXPECT_EQ(cut_out(*scene), nullptr);
}

}  // namespace
}  // namespace suite::test::cut_out_test
