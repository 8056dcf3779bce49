// Groups that are kept once: rays meet what they meet in the same scene unfolded, whatever the levels do to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <set>
#include <tuple>

#include "math/sampling.h"
#include "motion/track.h"
#include "scene/unfolded.h"
#include "surface/cut_out.h"
#include "tests/support/radiometry_kit.h"
#include "trace/tracer.h"

namespace suite::test::nested_test {
namespace {

constexpr double kAll = 0, kNothing = INFINITY;  // share as much as saves anything; unfold altogether

// Levels of groups, each of which places the next one three times and things of its own: lumps, a ball, a disk. All
// placements turn, scale and some mirror; some override materials and some have tags. A group of two things that is
// unfolded wherever it is placed hangs in each level, too.
struct Nest {
  std::shared_ptr<Scene> scene = std::make_shared<Scene>();
  Pcg32 rng;
  int levels;

  Nest(int deep, uint64_t seed, Vec3 offset = {}) : rng(seed), levels(deep) {
    scene->materials = {material("a", lambert(0.5)), material("b", lambert(0.4)), material("c", lambert(0.3)),
                        material("holed", lambert(0.2))};
    scene->meshes = {box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}, 0, true), quad(0.6, 0.1, 3)};
    scene->meshes[0].origin = {0.2, 0.1, 0};
    scene->meshes[1].uvs = {0, 0, 1, 0, 1, 1, 0, 1};
    scene->primitives = {{"ball", PrimitiveKind::sphere, {0.5}, 1}, {"disk", PrimitiveKind::disk, {0.5, 0}, 3}};
    scene->tags = {"one", "two", "three"};
    for (int level = 0; level <= deep; ++level) add(level, level == 0 ? offset : Vec3{});
    const auto pair = static_cast<uint32_t>(scene->groups.size());
    scene->groups.push_back({"pair", {at(TargetKind::mesh, 0, 1), at(TargetKind::primitive, 0, 1)}});
    for (uint32_t g = 1; g < pair; ++g) scene->groups[g].placements.push_back(at(TargetKind::group, pair, 1));
    check_scene(*scene, "nest");
  }
  Placement at(TargetKind kind, uint32_t target, double reach) {
    Placement p;
    p.kind = kind, p.target = target;
    const double scale = 0.5 + 0.4 * rng.uniform(), side = rng.uniform() < 0.3 ? -scale : scale;
    const Vec3 place{rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5};
    p.to_parent = translation(place * (4 * reach)) *
                  rotation(normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, 1}), 6 * rng.uniform()) *
                  scaling({side, scale, scale * (0.7 + 0.6 * rng.uniform())});
    if (rng.uniform() < 0.15) p.material_override = static_cast<uint32_t>(4 * rng.uniform());
    if (rng.uniform() < 0.3) p.tag = static_cast<uint32_t>(3 * rng.uniform());
    return p;
  }
  void add(int level, Vec3 offset) {
    Group g;
    g.name = strf("level%d", level);
    const double reach = std::pow(1.8, levels - level);
    if (level < levels)
      for (int i = 0; i < (level ? 3 : 4); ++i)
        g.placements.push_back(at(TargetKind::group, static_cast<uint32_t>(level) + 1, reach));
    for (const uint32_t k : {0u, 1u}) {
      g.placements.push_back(at(TargetKind::mesh, k, reach));
      g.placements.push_back(at(TargetKind::primitive, k, reach));
    }
    for (Placement& p : g.placements) p.to_parent.b += offset;
    scene->groups.push_back(g);
  }
  void add_holes() {
    PropertyMap m;
    m.name = "holes", m.kind = MapKind::opacity, m.projection = Projection::uv;
    m.width = m.height = 2;
    m.values = {0, 1, 0.5f, 0.3f};
    m.drape = {-10, 10, 20, 20, Drape::Extend::repeat};
    scene->property_maps = {m};
    scene->property_bindings = {{3, 0}};
  }
  void add_media() {
    scene->media.resize(1);
    scene->media[0].id = "m";
    scene->materials[0].inside = 0;
  }
  // Past the middles of random objects, from between them and from far away.
  std::vector<Ray> rays(size_t count, const Tracer& plain) {
    std::vector<Ray> all;
    for (size_t i = 0; i < count; ++i) {
      const auto inside = [&] {
        const auto n = static_cast<uint32_t>(rng.uniform() * static_cast<double>(plain.object_count()));
        return plain.place(n).b + Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5} * 0.3;
      };
      const Vec3 from = inside(), to = inside();
      const Dir d = normalized(to - from);
      all.push_back({i % 2 ? from : from - d * (3 * length(plain.bounds().size())), d, 0, static_cast<uint32_t>(i)});
    }
    return all;
  }
};

// Whether two hits of a ray are the same, but for what float rays leave open: u and v differ by some ulp, which shifts
// them in the surface's plane. aside: how far from its place it is looked for, m.
void expect_same(const Tracer& a, const Hit& x, const Tracer& b, const Hit& y, Dir along, double aside = 0) {
  ASSERT_EQ(x.hit(), y.hit());
  if (!x.hit()) return;
  const TracedObject o = a.object(x.object), p = b.object(y.object);
  EXPECT_EQ(o.instance, p.instance);
  EXPECT_EQ(o.mesh, p.mesh);
  EXPECT_EQ(o.primitive, p.primitive);
  EXPECT_EQ(o.material_override, p.material_override);
  EXPECT_EQ(o.tag, p.tag);
  EXPECT_EQ(x.triangle, y.triangle);
  // Every bit, but for copies in a cell that repeats: those of a group are shifted as a whole.
  Affine3 place = a.to_world(x);
  const Affine3 wanted = b.to_world(y);
  if (b.periodic() && length(place.b - wanted.b) < 1e-13) place.b = wanted.b;
  EXPECT_EQ(place, wanted);
  // u and v are quotients by something as small as the cosine; things are about a metre wide.
  const double cosine = std::fabs(dot(along, y.normal));
  const double bound = 2 * aside + 8 * FLT_EPSILON + 1e-15 * (length(y.position) + y.distance);
  EXPECT_LT(length(x.position - y.position) * cosine, bound) << cosine;
  EXPECT_LT(std::fabs(dot(x.position - y.position, y.normal)), bound);
  EXPECT_LT(std::fabs(x.distance - y.distance) * cosine, bound) << cosine;
  EXPECT_LT(length(x.normal - y.normal), 1e-6);
}

// All rays in both tracers, singly and in packets. Rays that pass two surfaces within what float tells apart may differ
// in which they take: at most `ties`.
void compare(const Tracer& nested, const Tracer& plain, std::span<const Ray> rays, size_t ties, double aside = 0) {
  const FlushDenormals flush;
  TraceStatistics statistics;
  std::vector<Hit> a(rays.size()), b(rays.size());
  size_t hits = 0, tied = 0;
  for (const bool coherent : {true, false}) {
    nested.nearest(rays, a, coherent, statistics);
    plain.nearest(rays, b, coherent, statistics);
    std::vector<double> before, behind;
    for (size_t i = 0; i < rays.size(); ++i) {
      before.push_back(b[i].hit() ? b[i].distance * (1 - 1e-6) - 1e-5 - 10 * aside : INFINITY);
      behind.push_back(b[i].hit() ? b[i].distance * (1 + 1e-6) + 1e-5 + 10 * aside : INFINITY);
      hits += b[i].hit();
      if (a[i].hit() && b[i].hit() && nested.object(a[i].object).instance != plain.object(b[i].object).instance &&
          std::fabs(a[i].distance - b[i].distance) < 2 * aside + 1e-6 * (1 + b[i].distance)) {
        ++tied;
        continue;
      }
      SCOPED_TRACE(i);
      expect_same(nested, a[i], plain, b[i], rays[i].direction, aside);
      if (testing::Test::HasFatalFailure()) return;
    }
    std::vector<uint8_t> blocked(rays.size());
    nested.occluded(rays, before, blocked, coherent, statistics);
    EXPECT_EQ(std::count(blocked.begin(), blocked.end(), 1), 0);
    nested.occluded(rays, behind, blocked, coherent, statistics);
    for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(blocked[i] == 1, b[i].hit()) << i;
  }
  EXPECT_GT(hits, rays.size() / 2);  // there is something to compare
  EXPECT_LE(tied, ties);
}

class Nested : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Levels, Nested, testing::Range(1, 6));

TEST_P(Nested, SameHitsAsUnfolded) {
  for (const uint64_t seed : {1, 2, 3}) {
    Nest nest(GetParam(), seed);
    const Sharing sharing = share_groups(*nest.scene, kAll);
    EXPECT_GE(std::count(sharing.shared.begin(), sharing.shared.end(), 1), GetParam());
    const Tracer nested(nest.scene, std::nullopt, {}, nullptr, {}, kAll),
        plain(nest.scene, std::nullopt, {}, nullptr, {}, kNothing);
    EXPECT_EQ(nested.triangles(), plain.triangles());
    EXPECT_EQ(nested.object_count(), plain.object_count());
    compare(nested, plain, nest.rays(4000, plain), 2);
  }
}

TEST_P(Nested, SameHolesAsUnfolded) {
  Nest nest(GetParam(), 4);
  nest.add_holes();
  const auto filter = cut_out(*nest.scene);
  const Tracer nested(nest.scene, std::nullopt, {}, filter, {}, kAll),
      plain(nest.scene, std::nullopt, {}, filter, {}, kNothing);
  compare(nested, plain, nest.rays(4000, plain), 2);
}

TEST_P(Nested, AllSurfacesAsUnfolded) {
  Nest nest(GetParam(), 5);
  nest.add_media();
  const Tracer nested(nest.scene, std::nullopt, {}, nullptr, {}, kAll),
      plain(nest.scene, std::nullopt, {}, nullptr, {}, kNothing);
  TraceStatistics statistics;
  std::vector<Hit> a, b;
  size_t most = 0;
  for (const Ray& ray : nest.rays(500, plain)) {
    nested.all(ray, 1000, a, statistics);
    plain.all(ray, 1000, b, statistics);
    ASSERT_EQ(a.size(), b.size());
    // Those closer together than float tells may come in another order.
    const auto before = [](const Tracer& t) {
      return [&t](const Hit& x, const Hit& y) {
        return std::tuple(t.object(x.object).instance, x.triangle, x.distance) <
               std::tuple(t.object(y.object).instance, y.triangle, y.distance);
      };
    };
    std::sort(a.begin(), a.end(), before(nested));
    std::sort(b.begin(), b.end(), before(plain));
    for (size_t i = 0; i < a.size(); ++i) expect_same(nested, a[i], plain, b[i], ray.direction);
    most = std::max(most, a.size());
  }
  EXPECT_GT(most, 3u);
}

TEST_P(Nested, SameHitsTenKilometresAway) {
  Nest nest(GetParam(), 6, {1e4, -7e3, 300});
  const Tracer nested(nest.scene, std::nullopt, {}, nullptr, {}, kAll),
      plain(nest.scene, std::nullopt, {}, nullptr, {}, kNothing);
  compare(nested, plain, nest.rays(4000, plain), 2);
}

TEST_P(Nested, SameHitsInACellThatRepeats) {
  Nest nest(GetParam(), 7);
  const Periodic cell{{-3, -4}, {5, 6}};
  const Tracer nested(nest.scene, cell, {}, nullptr, {}, kAll), plain(nest.scene, cell, {}, nullptr, {}, kNothing);
  compare(nested, plain, nest.rays(2000, plain), 4);
}

TEST(NestedMotion, SharedGroupsMoveAsAWhole) {
  Nest nest(2, 8);
  const TrackPtr turning = keyframe_track({{0, {{}, {}}}, {2, {quat_about({0, 0, 1}, 0.6), {4, 2, 0}}}});
  nest.scene->tracks = {{"turning", turning}};
  nest.scene->groups[0].placements[0].track = 0;
  nest.scene->groups[0].placements[1].track = 0;
  const Tracer nested(nest.scene, std::nullopt, {0, 2}, nullptr, {}, kAll),
      plain(nest.scene, std::nullopt, {0, 2}, nullptr, {}, kNothing);
  std::vector<Ray> rays = nest.rays(4000, plain);
  for (size_t i = 0; i < rays.size(); ++i) rays[i].time = 2.0 * static_cast<double>(i) / 4000;
  compare(nested, plain, rays, 4, motion_bound(10));  // of each, between keys
  size_t moved = 0;
  plain.each(
      "what moves", [](const TracedObject& o) { return o.node != kNone; }, [&](uint32_t, auto&) { ++moved; });
  size_t nested_moved = 0;
  nested.each(
      "what moves", [](const TracedObject& o) { return o.node != kNone; }, [&](uint32_t, auto&) { ++nested_moved; });
  EXPECT_EQ(moved, nested_moved);
  EXPECT_GT(moved, 0u);
}

// The dome of precision_test, three groups down, each of them away from its parent's zero by more than itself.
TEST(NestedPrecision, IsThatOfTheInnermostFrame) {
  auto scene = scene_of({dome(0.01), quad(0.001, 0, 0)}, {material("m", lambert(0.5))});
  Group forest{"forest", {}}, tree{"tree", {}}, root{"root", {}};
  for (int i = 0; i < 4; ++i) {
    Placement p;
    p.target = 0;
    p.to_parent = translation({30.0 * i, 7, 11});
    tree.placements.push_back(p);
    p.kind = TargetKind::group;
    p.target = 2;
    p.to_parent = translation({500, 800.0 * i, -3}) * rotation(normalized(Vec3{1, 2, 3}), 0.7);
    forest.placements.push_back(p);
    p.target = 1;
    p.to_parent = translation({1e4 + 5000.0 * i, 2e4, 0}) * rotation(normalized(Vec3{3, 1, 2}), 2);
    root.placements.push_back(p);
  }
  scene->groups = {root, forest, tree};
  check_scene(*scene, "domes");
  const Tracer tracer(scene, std::nullopt, {}, nullptr, {}, kAll);
  ASSERT_EQ(tracer.object_count(), 64u);
  TraceStatistics statistics;
  Pcg32 rng(3);
  std::vector<double> errors;
  size_t missed = 0, shadowed = 0;
  for (uint32_t n = 0; n < 64; ++n) {
    const Affine3 place = tracer.place(n);
    const Dir up = normalized(place.vector({0.2, 0.1, 1})), sun = normalized(place.vector({0.4, -0.3, 0.8}));
    for (int i = 0; i < 200; ++i) {
      const double x = (rng.uniform() - 0.5) * 0.0098, y = (rng.uniform() - 0.5) * 0.0098;
      const Vec3 target = place.point({x, y, -(x * x + y * y) / 0.1}), from = target + up * 2000.0;
      const Ray ray{from, normalized(target - from), 0};
      Hit hit;
      tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
      if (!hit.hit() || hit.object != n) {
        ++missed;
        continue;
      }
      const Vec3 offset = hit.position - ray.origin;
      errors.push_back(length(offset - ray.direction * dot(offset, ray.direction)));
      const Ray shade{tracer.leave(hit, sun), sun, 0};
      const double far = INFINITY;
      uint8_t blocked = 0;
      tracer.occluded({&shade, 1}, {&far, 1}, {&blocked, 1}, false, statistics);
      shadowed += blocked;
    }
  }
  EXPECT_EQ(missed, 0u);
  EXPECT_EQ(shadowed, 0u);
  std::sort(errors.begin(), errors.end());
  // Two ulp of the dome's half size, and what double leaves at 50 km.
  EXPECT_LE(errors[errors.size() * 99 / 100], 2 * 4.7e-10 + 8 * DBL_EPSILON * 5e4);
  std::printf("error p99 %.3g m\n", errors[errors.size() * 99 / 100]);
}

TEST(NestedObjects, AreFoundWithoutUnfolding) {
  Nest nest(3, 9);
  const Tracer nested(nest.scene, std::nullopt, {}, nullptr, {}, kAll),
      plain(nest.scene, std::nullopt, {}, nullptr, {}, kNothing);
  const auto list = [](const Tracer& t, const auto& wanted) {
    std::vector<std::tuple<uint32_t, uint32_t, uint32_t, uint32_t>> found;
    uint32_t last = 0;
    t.each("all", wanted, [&](uint32_t number, const TracedObject& o) {
      EXPECT_TRUE(found.empty() || number > last);
      last = number;
      const TracedObject same = t.object(number);
      EXPECT_EQ(same.instance, o.instance);
      EXPECT_EQ(same.tag, o.tag);
      EXPECT_EQ(same.material_override, o.material_override);
      EXPECT_EQ(t.of_instance(o.instance), std::vector<uint32_t>{number});
      found.emplace_back(o.instance, o.mesh, o.material_override, o.tag);
    });
    return found;
  };
  const auto tagged = [](const TracedObject& o) { return o.tag == 1 && o.mesh == 0; };
  EXPECT_EQ(list(nested, tagged), list(plain, tagged));
  EXPECT_FALSE(list(nested, tagged).empty());
  EXPECT_EQ(list(nested, [](const TracedObject&) { return true; }).size(), plain.object_count());
  const auto kinds = [](const Tracer& t) {
    std::set<std::tuple<uint32_t, uint32_t, uint32_t>> all;
    t.kinds([&](const TracedObject& o) { all.emplace(o.mesh, o.primitive, o.material_override); });
    return all;
  };
  EXPECT_EQ(kinds(nested), kinds(plain));
}

}  // namespace
}  // namespace suite::test::nested_test
