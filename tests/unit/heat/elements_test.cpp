// Elements: points and places, the budget, what moves, instances that share.
#include "heat/elements.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "math/stats.h"
#include "motion/track.h"
#include "support/heated_scene_kit.h"
#include "support/message_of.h"

namespace suite::elements_test {
namespace {

using namespace test;

HeatedScene mixed() {
  HeatedScene s;
  const uint32_t a = s.heated(0.9, heat()), b = s.heated(0.5, heat({}, {{"back", "open"}})), own = s.given(1, 290);
  s.plane(0, 0, a);
  s.mesh(dome(6), shifted({0, 0, 3}));
  Affine3 skewed = shifted({5, 0, 1});
  skewed.a = {2, 0.3, 0, 0, 1, 0, 0, 0, -0.5};
  s.mesh(box({0, 0, 0}, {1, 1, 1}, b, true), skewed);
  s.exact(PrimitiveKind::sphere, {0.7}, b, skewed);
  s.exact(PrimitiveKind::cylinder, {0.5, 2, 1}, a, shifted({-5, 3, 0.1}));
  s.exact(PrimitiveKind::cone, {0.5, 0.2, 1, 1}, b, shifted({-5, -3, 0.1}));
  s.exact(PrimitiveKind::sinusoid, {4, 3, 0.2, 3, 1, 0}, a, shifted({0, 8, 1}));
  s.exact(PrimitiveKind::disk, {1, 0.4}, own, shifted({0, -8, 1}));
  return s;
}

TEST(Elements, PointsAreWhereTheirElementIs) {
  for (const size_t budget : {1u, 50u, 3000u}) {
    const HeatKit kit(mixed(), budget);
    const Elements& elements = *kit.elements;
    size_t astray = 0, asked = 0;
    double sum = 0;
    for (size_t e = 0; e < elements.size(); ++e) {
      const SampleStream stream(1, 2, e);
      for (uint32_t k = 0; k < 8; ++k, ++asked) {
        const Hit hit = elements.point(e, {stream, k, 0});
        const auto found = elements.at(hit, elements[e].material);
        ASSERT_TRUE(found.has_value());
        astray += *found != e;
      }
      sum += elements[e].area;
      EXPECT_EQ(elements[e].share, 1);
    }
    EXPECT_NEAR(sum, elements.total_area(), 1e-9 * sum);
    EXPECT_LE(astray, asked / 500) << "of " << asked << " with a budget of " << budget;
    // At least one a face of what is heated; nothing has more than some times its part.
    EXPECT_LE(elements.size(), 2 * budget + 30);
    EXPECT_GE(2 * elements.size(), budget);
  }
}

// The same of elements that are cut where the sun differs, of which there are no more than asked for; and they are
// smaller where a shadow passes.
TEST(Elements, CutBySun) {
  const auto sun = [](double t) {
    const double hour = 2 * kPi * (t / 86400 - 0.5);
    return normalized(Vec3{-std::sin(hour), -0.5, std::cos(hour)});
  };
  const HeatKit kit(mixed(), 3000, {0, 86400}, sun);
  const Elements& elements = *kit.elements;
  size_t astray = 0, asked = 0;
  double sum = 0;
  std::array<double, 2> area{}, count{};  // of the endless ground: where shadows are, and far away
  for (size_t e = 0; e < elements.size(); ++e) {
    const SampleStream stream(1, 2, e);
    for (uint32_t k = 0; k < 8; ++k, ++asked)
      astray += elements.at(elements.point(e, {stream, k, 0}), elements[e].material) != e;
    sum += elements[e].area;
    const Vec3 c = elements[e].centre;
    if (std::fabs(c.z) > 1e-6) continue;
    const double off = std::hypot(c.x, c.y);
    if (off > 10 && off < 60) continue;
    area[off > 60] += elements[e].area, count[off > 60] += 1;
  }
  EXPECT_LE(astray, asked / 500);
  EXPECT_NEAR(sum, HeatKit(mixed(), 50).elements->total_area(), 2e-3 * sum);
  EXPECT_LE(elements.size(), 3000u);
  EXPECT_GE(elements.size(), 2990u);
  EXPECT_LT(area[0] / count[0], 0.1 * area[1] / count[1]);
  const HeatKit again(mixed(), 3000, {0, 86400}, sun);
  EXPECT_EQ(again.elements->fingerprint(), elements.fingerprint());
}

// Areas under transforms that do not keep shapes: of the box in closed form, of the ellipsoid by quadrature.
TEST(Elements, AreasUnderSkewedPlacements) {
  Affine3 skewed;
  skewed.a = {2, 0, 0, 0, 1, 0, 0, 0, 0.5};
  const auto area = [&](bool sphere) {
    HeatedScene s;
    const uint32_t m = s.heated(0.9, heat());
    if (sphere)
      s.exact(PrimitiveKind::sphere, {1}, m, skewed);
    else
      s.mesh(box({0, 0, 0}, {1, 1, 1}, m, true), skewed);
    return HeatKit(std::move(s), 2000).elements->total_area();
  };
  EXPECT_NEAR(area(false), 2 * (2 * 1 + 2 * 0.5 + 1 * 0.5), 1e-6);
  double exact = 0;
  constexpr int n = 2000;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 64; ++j) {
      const double z = 2 * (i + 0.5) / n - 1, s = std::sqrt(1 - z * z), phi = 2 * kPi * (j + 0.5) / 64;
      exact += length(skewed.normal({s * std::cos(phi), s * std::sin(phi), z})) * 4 * kPi / (n * 64);
    }
  EXPECT_NEAR(area(true), exact, 2e-3 * exact);
}

// Many small instances of one mesh share elements with their neighbours; what moves has none.
TEST(Elements, InstancesShareAndWhatMovesHasNone) {
  HeatedScene s;
  const uint32_t m = s.heated(0.9, heat());
  const Mesh leaf = quad(0.05, 0, m);
  s.mesh(quad(10, 0, m));
  s.mesh(leaf, shifted({0, 0, 1}));
  auto scene = s.scene();
  Placement p = scene->groups[0].placements.back();
  for (int k = 1; k < 400; ++k) {
    p.to_parent.b = {0.2 * (k % 20), 0.2 * (k / 20), 1};
    scene->groups[0].placements.push_back(p);
  }
  const HeatKit still(s, 100);
  EXPECT_EQ(still.elements->instances(), 401u);
  EXPECT_EQ(still.elements->moving(), 0u);
  EXPECT_LT(still.elements->size(), 120u);
  EXPECT_NEAR(still.elements->total_area(), 400 + 400 * 0.01, 1e-6);

  scene->tracks.push_back({"t", keyframe_track({{0, {{}, {}}}, {86400, {{}, {0, 0, 1}}}})});
  scene->groups[0].placements.back().track = 0;
  const HeatKit moved(s, 100);
  EXPECT_EQ(moved.elements->moving(), 1u);
  EXPECT_NEAR(moved.elements->total_area(), 400 + 399 * 0.01, 1e-6);
  EXPECT_NE(moved.elements->fingerprint(), still.elements->fingerprint());
}

// What only comes and goes is at rest while it is there.
TEST(Elements, WhatComesAndGoesHasSome) {
  HeatedScene s;
  const uint32_t m = s.heated(0.9, heat());
  s.mesh(quad(10, 0, m));
  s.mesh(quad(1, 0, m), shifted({0, 0, 1}));
  auto scene = s.scene();
  scene->schedules.push_back({"leaves", {0, 43200}, {}, {}, {}});
  scene->groups[0].placements.back().schedule = 0;
  const HeatKit kit(s, 100);
  EXPECT_EQ(kit.elements->moving(), 0u);
  EXPECT_NEAR(kit.elements->total_area(), 404, 1e-6);
}

TEST(Elements, SameSceneSameFingerprint) {
  const HeatKit a(mixed(), 200), b(mixed(), 200), finer(mixed(), 400);
  EXPECT_EQ(a.elements->fingerprint(), b.elements->fingerprint());
  EXPECT_NE(a.elements->fingerprint(), finer.elements->fingerprint());
}

// Elements that are left take the same paths as with all, whatever their numbers are then, backs too.
TEST(Elements, LeavingSomeOutChangesNoPathsOfOthers) {
  const HeatKit kit(mixed(), 3000);
  std::vector<bool> kept(kit.elements->size());
  for (size_t e = 0; e < kept.size(); ++e) kept[e] = e % 3 != 1;
  Elements some(*kit.tracer, kit.optics.has_heat, 3000, 0);
  some.keep(kept);
  const HeatFaces few(some, kit.optics);
  const PathOptions paths{2, 2, 3};
  const SunCourse course = still_sun(normalized(Vec3{1, 0.3, 1}), 0.005, {0, 600, 1200});
  const Sunlight all = kit.sunlight(course, paths),
                 left = trace_sunlight(*kit.tracer, some, few, kit.optics, course, paths);
  size_t backs = 0, lit = 0;
  RunningStats changes;
  for (size_t f = 0; f < few.size(); ++f) {
    const size_t was = few.number(f);
    EXPECT_EQ(kit.faces->is_back(was), few.is_back(f));
    EXPECT_EQ(kit.faces->element(was), some.number(few.element(f)));
    // Where the sun is on those that were left out is not told: what these send on scatters more, about the same mean.
    double change = 0;
    for (size_t k = 0; k < 3; ++k) change += (left.beam.at(f, k) - all.beam.at(was, k)) / 3;
    changes.add(change);
    for (size_t p = 0; p < kSkyPatches; ++p) EXPECT_EQ(left.sky.at(f, p), all.sky.at(was, p)) << f;
    backs += few.is_back(f), lit += left.beam.at(f, 0) > 0;
  }
  EXPECT_LT(std::fabs(changes.mean()), 3 * changes.stderr_of_mean() + 1e-9);
  EXPECT_GE(backs, 2u);
  EXPECT_GT(lit, 10u);
}

// In a cell of two materials of a map, places of the one that was left out are not the other's.
TEST(Elements, LeftOutOfACellOfAMap) {
  HeatedScene s;
  const uint32_t a = s.heated(0.9, heat()), b = s.heated(0.5, heat());
  s.mesh(quad(1, 0, a));
  ClassMap map;
  map.name = "halves", map.width = 2, map.height = 1, map.classes = {0, 1}, map.materials = {a, b};
  map.drape = {-1, 1, 1, 2, Drape::Extend::none};
  s.scene()->class_maps = {map};
  s.scene()->map_bindings = {{a, 0}};
  const HeatKit kit(std::move(s), 1);
  Elements elements(*kit.tracer, kit.optics.has_heat, 1, 0);
  ASSERT_GT(elements.shared_cells(), 0u);
  std::vector<bool> kept(elements.size());
  std::vector<Hit> places;
  for (size_t e = 0; e < kept.size(); ++e) {
    kept[e] = elements[e].material == a;
    places.push_back(elements.point(e, {SampleStream(1, 0, e), 0, 0}));
  }
  const Elements whole(*kit.tracer, kit.optics.has_heat, 1, 0);
  elements.keep(kept);
  for (size_t e = 0; e < kept.size(); ++e)
    EXPECT_EQ(elements.at(places[e], whole[e].material).has_value(), static_cast<bool>(kept[e])) << e;
}

// What was cut by a sun is cut again without asking it: a sun that shines nowhere leads elsewhere.
TEST(Elements, CutsThatAreKnownNeedNoSun) {
  const HeatKit kit(mixed(), 10);
  const auto& heated = kit.optics.has_heat;
  const DaySun sun = day_sun(*kit.tracer, {{0, 900, normalized(Vec3{1, 0.3, 0.5})}}), night = day_sun(*kit.tracer, {});
  const Elements cut(*kit.tracer, heated, 300, 0, &sun), again(*kit.tracer, heated, 300, 0, &night, cut.splits()),
      dark(*kit.tracer, heated, 300, 0, &night);
  ASSERT_GT(cut.splits().size(), 50u);
  EXPECT_EQ(cut.fingerprint(), again.fingerprint());
  EXPECT_EQ(cut.splits(), again.splits());
  EXPECT_NE(cut.fingerprint(), dark.fingerprint());  // negative control
  for (const CellSplit wrong : {CellSplit{1000, 0}, CellSplit{0, 1u << 30}}) {
    const std::vector<CellSplit> splits{wrong};
    EXPECT_NE(message_of([&] { Elements(*kit.tracer, heated, 300, 0, &night, splits); }).find("another scene"),
              std::string::npos);
  }
}

TEST(Elements, RefuseScenesWithoutAny) {
  HeatedScene s;
  s.plane(1, 1, s.given(1, 300));
  EXPECT_NE(message_of([&] { HeatKit(s, 10); }).find("temperature: {model: heat}"), std::string::npos);
}

}  // namespace
}  // namespace suite::elements_test
