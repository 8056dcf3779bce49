// Exact surfaces against their fine tessellation, placed with rotation, scale and mirroring: the same points are hit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "math/sampling.h"
#include "scene/primitives.h"
#include "tests/support/radiometry_kit.h"
#include "trace/primitive_hit.h"
#include "trace/tracer.h"

namespace suite::test::primitive_test {
namespace {

using Surface2 = std::function<Vec3(double, double)>;

// n x n quads over the unit square of parameters.
void tessellate(std::vector<Vec3>& v, std::vector<uint32_t>& f, const Surface2& s, uint32_t n) {
  const auto base = static_cast<uint32_t>(v.size());
  for (uint32_t j = 0; j <= n; ++j)
    for (uint32_t i = 0; i <= n; ++i) v.push_back(s(double(i) / n, double(j) / n));
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = base + j * (n + 1) + i;
      for (const uint32_t k : {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1}) f.push_back(k);
    }
}

struct Case {
  const char* name;
  PrimitiveKind kind;
  std::vector<double> parameters;
  std::vector<Surface2> faces;
};

Vec3 polar(double r, double turn, double z) { return {r * std::cos(2 * kPi * turn), r * std::sin(2 * kPi * turn), z}; }

std::vector<Case> cases() {
  return {
      {"plane", PrimitiveKind::plane, {2, 1}, {[](double u, double v) {
         return Vec3{2 * u - 1, v - 0.5, 0};
       }}},
      {"disk", PrimitiveKind::disk, {1, 0.3}, {[](double u, double v) { return polar(0.3 + 0.7 * u, v, 0); }}},
      {"box",
       PrimitiveKind::box,
       {-1, -0.5, 0, 1, 0.5, 0.7},
       {[](double u, double v) {
          return Vec3{2 * u - 1, v - 0.5, 0};
        },
        [](double u, double v) {
          return Vec3{2 * u - 1, v - 0.5, 0.7};
        },
        [](double u, double v) {
          return Vec3{-1, u - 0.5, 0.7 * v};
        },
        [](double u, double v) {
          return Vec3{1, u - 0.5, 0.7 * v};
        },
        [](double u, double v) {
          return Vec3{2 * u - 1, -0.5, 0.7 * v};
        },
        [](double u, double v) {
          return Vec3{2 * u - 1, 0.5, 0.7 * v};
        }}},
      {"sphere", PrimitiveKind::sphere, {0.8}, {[](double u, double v) {
         return dir_from_angles(kPi * v, 2 * kPi * u) * 0.8;
       }}},
      {"frustum",
       PrimitiveKind::cone,
       {0.8, 0.3, 1, 1},
       {[](double u, double v) { return polar(0.8 - 0.5 * v, u, v); },
        [](double u, double v) { return polar(0.8 * u, v, 0); },
        [](double u, double v) { return polar(0.3 * u, v, 1); }}},
      {"cone_open", PrimitiveKind::cone, {0.8, 0, 1, 0}, {[](double u, double v) {
         return polar(0.8 * (1 - v), u, v);
       }}},
      {"cylinder",
       PrimitiveKind::cylinder,
       {0.6, 1.2, 1},
       {[](double u, double v) { return polar(0.6, u, 1.2 * v); },
        [](double u, double v) { return polar(0.6 * u, v, 0); },
        [](double u, double v) { return polar(0.6 * u, v, 1.2); }}},
      {"cylinder_open", PrimitiveKind::cylinder, {0.6, 1.2, 0}, {[](double u, double v) {
         return polar(0.6, u, 1.2 * v);
       }}},
      {"sinusoid", PrimitiveKind::sinusoid, {2, 1.5, 0.1, 9, 2, 0.3, 0.04, -5, 17, 1}, {[](double u, double v) {
         const double x = 2 * (u - 0.5), y = 1.5 * (v - 0.5);
         return Vec3{x, y, 0.1 * std::sin(9 * x + 2 * y + 0.3) + 0.04 * std::sin(-5 * x + 17 * y + 1)};
       }}},
  };
}

class Exact : public testing::TestWithParam<size_t> {};

TEST_P(Exact, AgreesWithItsTessellation) {
  const Case c = cases()[GetParam()];
  const Affine3 place =
      translation({3, -2, 5}) * rotation(normalized(Vec3{1, 0.4, -0.3}), 1.1) * scaling({1.3, 1.3, -1.3});
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  for (const Surface2& s : c.faces) tessellate(v, f, s, 300);
  auto meshes = scene_of({mesh_of(v, f, 0)}, {material("m", lambert(0.5))});
  meshes->groups[0].placements[0].to_parent = place;
  auto exact = scene_of({}, {material("m", lambert(0.5))});
  exact->primitives.push_back({c.name, c.kind, c.parameters, 0});
  Placement p;
  p.kind = TargetKind::primitive;
  p.to_parent = place;
  exact->groups[0].placements.push_back(p);
  check_scene(*exact, "exact");

  const Tracer a(meshes), b(exact);
  Pcg32 rng(3);
  TraceStatistics statistics;
  int both = 0, differ = 0;
  for (int i = 0; i < 20000; ++i) {
    const Dir d = normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5});
    const Vec3 target = place.point({2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 1.2 * rng.uniform()});
    const Ray ray{target - d * 6.0, d, 0};
    Hit ha, hb;
    a.nearest({&ray, 1}, {&ha, 1}, false, statistics);
    b.nearest({&ray, 1}, {&hb, 1}, false, statistics);
    uint8_t blocked = 0;
    const double far = INFINITY;
    b.occluded({&ray, 1}, {&far, 1}, {&blocked, 1}, false, statistics);
    EXPECT_EQ(blocked != 0, hb.hit());
    if (ha.hit() != hb.hit()) {
      ++differ;
      continue;
    }
    if (!ha.hit()) continue;
    ++both;
    // Chords of 1/300 of a turn sag by 5.5e-5 of the radius; along a grazing ray that is stretched.
    const double grazing = std::fabs(dot(ray.direction, hb.normal));
    if (std::fabs(ha.distance - hb.distance) > 2.6e-4 / std::max(grazing, 0.02)) ++differ;
    EXPECT_NEAR(dot(ray.direction * hb.distance + ray.origin - hb.position, hb.normal), 0, 1e-9);
  }
  EXPECT_GT(both, 2000);
  EXPECT_LT(differ, both / 200) << "beyond silhouettes";
}
INSTANTIATE_TEST_SUITE_P(Table, Exact, testing::Range(size_t{0}, cases().size()),
                         [](const auto& one) { return std::string(cases()[one.param].name); });

TEST(Exact, SpheresFromAMillimetreToAHundredKilometres) {
  for (const double radius : {1e-3, 1.0, 1e5}) {
    auto scene = scene_of({}, {material("m", lambert(0.5))});
    scene->primitives.push_back({"s", PrimitiveKind::sphere, {radius}, 0});
    Placement p;
    p.kind = TargetKind::primitive;
    scene->groups[0].placements.push_back(p);
    const Tracer tracer(scene);
    Pcg32 rng(5);
    TraceStatistics statistics;
    for (int i = 0; i < 2000; ++i) {
      const Dir d = normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5});
      const Vec3 aim = Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5} * radius;
      const Ray ray{aim - d * (50 * radius), d, 0};
      Hit hit;
      tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
      ASSERT_TRUE(hit.hit());
      EXPECT_NEAR(length(hit.position) / radius, 1, 1e-12);
      // A sun above the tangent plane is not blocked by the sphere itself.
      const Ray sun{tracer.leave(hit, hit.normal),
                    normalized(hit.normal + cross(hit.normal, Vec3{0.3, 0.5, 0.1}) * 20.0), 0};
      uint8_t blocked = 0;
      const double far = INFINITY;
      tracer.occluded({&sun, 1}, {&far, 1}, {&blocked, 1}, false, statistics);
      EXPECT_EQ(blocked, 0) << radius;
    }
  }
}

TEST(Exact, InfinitePlaneIsMetInDouble) {
  auto scene = scene_of({quad(1, 2, 0)}, {material("m", lambert(0.5))});
  scene->primitives.push_back({"ground", PrimitiveKind::plane, {0, 0}, 0});
  Placement p;
  p.kind = TargetKind::primitive;
  scene->groups[0].placements.push_back(p);
  const Tracer tracer(scene);
  TraceStatistics statistics;
  const Ray rays[3] = {{{0.1, 0.1, 10}, {0, 0, -1}, 0}, {{5e6, 3, 7e5}, {0, 0, -1}, 0}, {{0, 0, 3}, {0, 0, 1}, 0}};
  Hit hits[3];
  tracer.nearest(rays, hits, false, statistics);
  EXPECT_EQ(hits[0].position.z, 2);  // the square stands before it
  ASSERT_TRUE(hits[1].hit());
  EXPECT_NEAR(hits[1].position.z, 0, 1e-9);
  EXPECT_FALSE(hits[2].hit());
}

// The roots of waves are found by Newton's steps: from near and from orbit, steep and grazing, they lie on the surface
// as exactly as the ray can say, and none comes before them.
TEST(Exact, WavesAreMetOnThemselvesAndFirst) {
  const std::vector<double> a{40, 40, 0.3, 1.1, 0.4, 0.3, 0.05, -3, 7, 1, 0.01, 21, -13, 2};
  const Primitive waves{"waves", PrimitiveKind::sinusoid, a, 0};
  const auto height = [&](Vec3 p) {
    double z = p.z;
    for (size_t i = 2; i < a.size(); i += 4) z -= a[i] * std::sin(a[i + 1] * p.x + a[i + 2] * p.y + a[i + 3]);
    return z;
  };
  Pcg32 random(7, 3);
  int met = 0;
  for (int n = 0; n < 4000; ++n) {
    const double far = n % 2 ? 10 : 8e5;
    const Vec3 to{30 * (random.uniform() - 0.5), 30 * (random.uniform() - 0.5), 0.6 * (random.uniform() - 0.5)};
    const double z = n % 3 ? random.uniform() : 0.02 * random.uniform(), turn = 2 * kPi * random.uniform(),
                 across = std::sqrt(1 - z * z);
    const Vec3 from = to + Vec3{across * std::cos(turn), across * std::sin(turn), n % 5 ? z : -z} * far;
    const Vec3 along = normalized(to - from);
    const double t = distance_to(waves, from, along, 0, INFINITY);
    if (!std::isfinite(t)) continue;
    ++met;
    // Places along the ray are rounded to 2.2e-16 of their distance, thrice, and the slope is at most 1.
    EXPECT_LE(std::fabs(height(from + along * t)), 4e-15 * far + 1e-14) << n;
    const double begin = std::max(0.0, t - 3);
    std::optional<bool> above;  // where it comes over the rectangle
    for (int k = 0; k < 300; ++k) {
      const Vec3 p = from + along * (begin + (t - begin) * k / 300);
      if (std::fabs(p.x) > 20 || std::fabs(p.y) > 20) continue;
      const double before = height(p);
      if (!above) above = before > 0;
      EXPECT_TRUE((before > 0) == *above || std::fabs(before) < 1e-9) << n << " " << k;
    }
  }
  EXPECT_GT(met, 1000);
}

}  // namespace
}  // namespace suite::test::primitive_test
