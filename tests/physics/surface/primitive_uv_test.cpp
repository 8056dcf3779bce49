// Texture coordinates of exact surfaces: continuous over each face, and their tangents are the derivatives of position,
// measured by rays a little aside. The seams (azimuth 0, poles, edges between faces) are where u or v may jump.
#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"
#include "surface/tangents.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::primitive_uv_test {
namespace {

struct Case {
  const char* name;
  PrimitiveKind kind;
  std::vector<double> parameters;
};
std::vector<Case> cases() {
  return {{"plane", PrimitiveKind::plane, {2, 1}},
          {"infinite_plane", PrimitiveKind::plane, {0, 0}},
          {"disk", PrimitiveKind::disk, {1, 0.3}},
          {"box", PrimitiveKind::box, {-1, -0.5, 0, 1, 0.5, 0.7}},
          {"sphere", PrimitiveKind::sphere, {0.8}},
          {"frustum", PrimitiveKind::cone, {0.8, 0.3, 1, 1}},
          {"cone_open", PrimitiveKind::cone, {0.8, 0, 1, 0}},
          {"cylinder", PrimitiveKind::cylinder, {0.6, 1.2, 1}},
          {"sinusoid", PrimitiveKind::sinusoid, {2, 1.5, 0.1, 9, 2, 0.3, 0.04, -5, 17, 1}}};
}

class PrimitiveUv : public testing::TestWithParam<size_t> {};

TEST_P(PrimitiveUv, IsContinuousAndItsTangentsAreItsDerivatives) {
  const Case c = cases()[GetParam()];
  auto scene = scene_of({}, {material("m", lambert(0.5))});
  scene->primitives.push_back({c.name, c.kind, c.parameters, 0});
  Placement p;
  p.kind = TargetKind::primitive;
  p.to_parent = translation({3, -2, 5}) * rotation(normalized(Vec3{1, 0.4, -0.3}), 1.1) * scaling({1.3, 0.7, -1.3});
  scene->groups[0].placements.push_back(p);
  check_scene(*scene, "exact");
  const Tracer tracer(scene);
  const TracedObject object = tracer.object(0);
  const FlushDenormals flush;
  TraceStatistics statistics;
  const auto shoot = [&](Vec3 from, Dir along) {
    const Ray ray{from, along, 0};
    Hit hit;
    tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
    return hit;
  };
  Pcg32 rng(3);
  int compared = 0, jumps = 0;
  for (int i = 0; i < 5000; ++i) {
    const Dir d = normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5});
    const Vec3 target = p.to_parent.point({2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 1.2 * rng.uniform()});
    const Hit here = shoot(target - d * 6.0, d);
    if (!here.hit() || here.distance > 12) continue;  // u and v of an infinite plane are metres, as floats
    const SurfaceTangents t = tangents_at(tracer.scene(), tracer.to_world(here), object, here);
    EXPECT_NEAR(dot(normalized(t.dpdu), here.normal), 0, 1e-9);
    EXPECT_NEAR(dot(normalized(t.dpdv), here.normal), 0, 1e-9);
    // 1e-3 further along each tangent, seen along the normal; hits are in double, u and v in float.
    for (const bool along_u : {true, false}) {
      const Vec3 tangent = along_u ? t.dpdu : t.dpdv;
      const double step = 1e-3 * std::fmin(1, length(tangent));
      const Dir side = dot(here.normal, d) < 0 ? here.normal : -here.normal;
      const Hit there = shoot(here.position + normalized(tangent) * step + side * 0.01, -side);
      if (!there.hit() || dot(there.normal, here.normal) < 0.9) continue;  // over an edge
      const double du = there.u - here.u, dv = there.v - here.v, expected = step / length(tangent);
      ++compared;
      if (std::fabs(du) > 0.5 || std::fabs(dv) > 0.5) {
        ++jumps;  // the seam at azimuth 0
        continue;
      }
      // Curvature makes the step a second-order one.
      EXPECT_NEAR(along_u ? du : dv, expected, 0.02 * expected + 4e-6) << c.name << ' ' << along_u;
      EXPECT_NEAR(along_u ? dv : du, 0, 0.02 * expected + 2e-5) << c.name << ' ' << along_u;
    }
  }
  EXPECT_GT(compared, 500);
  EXPECT_LE(jumps, compared / 100);
}
INSTANTIATE_TEST_SUITE_P(Table, PrimitiveUv, testing::Range(size_t{0}, cases().size()),
                         [](const auto& one) { return std::string(cases()[one.param].name); });

// The same radiance from an exact sphere and from its fine tessellation with vertex normals, under sun and sky.
TEST(PrimitiveRadiance, EqualsThatOfItsTessellation) {
  constexpr uint32_t n = 200;
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  for (uint32_t j = 0; j <= n; ++j)
    for (uint32_t i = 0; i <= n; ++i) v.push_back(dir_from_angles(kPi * j / n, 2 * kPi * i / n));
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = j * (n + 1) + i;
      for (const uint32_t k : {a, a + n + 1, a + 1, a + 1, a + n + 1, a + n + 2}) f.push_back(k);
    }
  Mesh ball = mesh_of(v, f, 0);
  std::vector<uint32_t> normals;
  for (const Vec3& at : v) normals.push_back(oct_encode(at));
  ball.normals = std::move(normals);
  const Material m = material("m", lambert(0.5)), ground = material("g", lambert(0.3));
  auto fine = scene_of({ball, quad(5, -1, 1)}, {m, ground});
  auto exact = scene_of({quad(5, -1, 1)}, {m, ground});
  exact->primitives.push_back({"ball", PrimitiveKind::sphere, {1}, 0});
  Placement p;
  p.kind = TargetKind::primitive;
  exact->groups[0].placements.push_back(p);
  std::vector<Ray> rays;
  for (int i = 0; i < 40; ++i) {
    const Dir out = dir_from_angles(0.2 + 0.02 * i, 0.7 * i);
    rays.push_back({out * 5.0 + Vec3{0.6 * std::sin(i), 0.6 * std::cos(i), 0}, -out, 0});
  }
  SourceSpecs sources;
  sources.add(SunSpec{normalized(Vec3{0.3, 0.2, 1}), 0.00465, Curve::constant(2)});
  sources.add(uniform_sky(0.2, false));
  const auto a = render(fine, sources, std::make_unique<RaySensor>(rays, one_band(), 2048)).result;
  const auto b = render(exact, sources, std::make_unique<RaySensor>(rays, one_band(), 2048)).result;
  int compared = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const double noise = std::hypot(a.standard_error[i], b.standard_error[i]);
    EXPECT_NEAR(a.radiance[i], b.radiance[i], 5 * noise + 2e-3 * a.radiance[i]) << i;
    compared += a.radiance[i] > 0;
  }
  EXPECT_GT(compared, 30);
}

}  // namespace
}  // namespace suite::test::primitive_uv_test
