// Rays that leave a flat surface do not meet it again, however it is placed, however large it is, and wherever on it
// they start: near the zero of its floats, where the step off it is smallest, and far from it. A step of nothing is the
// control.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "math/sampling.h"
#include "tests/support/radiometry_kit.h"
#include "trace/tracer.h"

namespace suite::test::leave_test {
namespace {

enum class Kind { alone, beside_a_sphere, turned, scaled, mirrored, nested, plane };
constexpr const char* kNames[] = {"alone", "beside a sphere", "turned", "scaled", "mirrored", "nested", "plane"};

std::shared_ptr<Scene> scene_with(Kind kind, double half, Vec3 origin) {
  // The mesh leans by itself; what is turned leans further.
  const Affine3 lean = rotation(normalized(Vec3{1, 0.7, 0.2}), 0.4);
  std::vector<Vec3> corners;
  for (const Vec3 c : {Vec3{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}})
    corners.push_back(lean.point(c));
  auto scene = scene_of({mesh_of(corners, {0, 1, 2, 0, 2, 3}, 0)}, {material("m", lambert(0.5))});
  Placement& p = scene->groups[0].placements[0];
  Affine3 place = translation(origin);
  if (kind == Kind::turned) place = place * rotation(normalized(Vec3{0.3, 1, 0.5}), 0.3);
  if (kind == Kind::scaled) place = place * scaling({1.7, 0.6, 1.1});
  if (kind == Kind::mirrored) place = place * scaling({-1, 1, 1});
  p.to_parent = place;
  if (kind == Kind::plane) {
    scene->primitives.push_back({"p", PrimitiveKind::plane, {2 * half, 2 * half}, 0});
    p.kind = TargetKind::primitive, p.target = 0, p.to_parent = place * lean;
  }
  if (kind == Kind::beside_a_sphere) {
    scene->primitives.push_back({"s", PrimitiveKind::sphere, {0.1 * half}, 0});
    Placement s;
    s.kind = TargetKind::primitive, s.to_parent = translation(origin + Vec3{3 * half, 0, -half});
    scene->groups[0].placements.push_back(s);
  }
  if (kind == Kind::nested) {
    Group inner = scene->groups[0];
    inner.name = "inner";
    for (Placement& i : inner.placements) i.to_parent = rotation({0, 0, 1}, 0.2);
    scene->groups.push_back(inner);
    scene->groups[0].placements[0].kind = TargetKind::group, scene->groups[0].placements[0].target = 1;
  }
  check_scene(*scene, "leave");
  return scene;
}

// Of rays to places about `from` times the half width away from the middle: how many leave and meet the surface again.
int met_again(Kind kind, double half, Vec3 origin, double from, double camera, double share_of_step) {
  const Tracer tracer(scene_with(kind, half, origin), std::nullopt, {}, nullptr, {}, kind == Kind::nested ? 0 : 1e9);
  Pcg32 rng(3);
  const FlushDenormals flush;
  TraceStatistics statistics;
  int again = 0, hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Dir down = normalized(Vec3{rng.uniform() - 0.5, rng.uniform() - 0.5, -1});
    const Vec3 to = origin + Vec3{(rng.uniform() - 0.5) * from * half, (rng.uniform() - 0.5) * from * half, 0};
    const Ray ray{to - down * camera, down, 0};
    Hit hit;
    tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
    if (!hit.hit()) continue;
    ++hits;
    hit.step *= static_cast<float>(share_of_step);
    const Frame frame = Frame::around(hit.normal);
    const double cosine = std::pow(10, -3 * rng.uniform()), sine = std::sqrt(1 - cosine * cosine);
    for (const double side : {1.0, -1.0}) {
      const double turn = 2 * kPi * rng.uniform();
      const Dir out = frame.to_world({sine * std::cos(turn), sine * std::sin(turn), side * cosine});
      const Ray on{tracer.leave(hit, out), out, 0};
      const double far = 0.1 * half;
      uint8_t blocked = 0;
      tracer.occluded({&on, 1}, {&far, 1}, {&blocked, 1}, false, statistics);
      again += blocked;
    }
  }
  EXPECT_GT(hits, 900);
  return again;
}

TEST(Leave, NothingMeetsItselfAgain) {
  int control = 0;
  for (const Kind kind :
       {Kind::alone, Kind::beside_a_sphere, Kind::turned, Kind::scaled, Kind::mirrored, Kind::nested, Kind::plane})
    for (const double half : {0.01, 1.0, 50.0, 1500.0})
      for (const Vec3 origin : {Vec3{}, Vec3{1e5, 3e4, 0}})
        for (const double from : {1e-3, 0.1, 1.0})
          for (const double camera : {1.0, 3.6e7}) {
            if (camera > 1e6 && from * half < 1e-3) continue;
            EXPECT_EQ(met_again(kind, half, origin, from, camera, 1), 0)
                << kNames[static_cast<int>(kind)] << ", " << 2 * half << " m wide, within " << from
                << " of the middle, " << length(origin) << " m away, camera at " << camera << " m";
            if (camera == 1.0 && half == 50.0) control += met_again(kind, half, origin, from, camera, 0) > 100;
          }
  EXPECT_GT(control, 30);  // of 42 places
}

}  // namespace
}  // namespace suite::test::leave_test
