// Frames, angles and affine maps, degenerate directions included.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "math/quick_angle.h"
#include "math/sampling.h"
#include "math/vec.h"
#include "math/warps.h"

namespace suite::vec_test {

namespace {

void expect_near(Vec3 a, Vec3 b, double tolerance) {
  EXPECT_LE(length(a - b), tolerance) << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " "
                                      << b.z;
}

std::vector<Dir> directions() {
  std::vector<Dir> all{{1, 0, 0},
                       {0, 1, 0},
                       {0, 0, 1},
                       {-1, 0, 0},
                       {0, -1, 0},
                       {0, 0, -1},
                       normalized({1e-9, 0, -1}),
                       normalized({1e-200, 1e-9, -1}),
                       normalized({0, 1e-5, 1})};
  Pcg32 rng(3);
  for (int i = 0; i < 200; ++i) all.push_back(uniform_sphere({rng.uniform(), rng.uniform()}));
  return all;
}

}  // namespace

TEST(Frame, AroundAnyDirectionIsOrthonormalAndRightHanded) {
  for (const Dir n : directions())
    for (const Frame& f : {Frame::around(n), Frame::with_tangent(n, {0.3, -2, 0.1}), Frame::with_tangent(n, n),
                           Frame::with_tangent(n, n + Vec3{3e-9, 5e-9, -1e-8}), Frame::with_tangent(n, {0, 0, 0})}) {
      EXPECT_NEAR(length(f.x), 1, 1e-15);
      EXPECT_NEAR(length(f.y), 1, 1e-15);
      EXPECT_NEAR(dot(f.x, f.y), 0, 1e-15);
      EXPECT_NEAR(dot(f.x, f.z), 0, 1e-15);
      expect_near(cross(f.x, f.y), f.z, 1e-15);
      expect_near(f.to_local(n), {0, 0, 1}, 1e-15);
      expect_near(f.to_world(f.to_local({1, 2, 3})), {1, 2, 3}, 4e-15);  // 4 ulp of its length
    }
  EXPECT_GT(dot(Frame::with_tangent({0, 0, 1}, {0, 5, 2}).x, Vec3{0, 1, 0}), 1 - 1e-15);
}

TEST(Angles, KeepTheirDigitsNearZeroAndPi) {
  for (const double angle : {1e-12, 1e-8, 1e-3, 1.0, kPi / 2, kPi - 1e-8}) {
    const Dir a{0, 0, 1}, b = dir_from_angles(angle, 0.7);
    EXPECT_NEAR(angle_between(a, b) / angle, 1, 1e-14) << angle;
    EXPECT_NEAR(polar_angle(b) / angle, 1, 1e-14) << angle;
  }
  EXPECT_EQ(angle_between({1, 0, 0}, {1, 0, 0}), 0);
  EXPECT_NEAR(azimuth(dir_from_angles(1, -2.5)), -2.5, 1e-15);
  EXPECT_NEAR(one_minus_cos(1e-9) / 5e-19, 1, 1e-12);
}

TEST(Angles, CompassConvention) {
  EXPECT_NEAR(azimuth_from_compass_deg(0), kPi / 2, 1e-15);  // north is +y
  EXPECT_NEAR(azimuth_from_compass_deg(90), 0, 1e-15);       // east is +x
  EXPECT_NEAR(azimuth_from_compass_deg(180), -kPi / 2, 1e-15);
}

TEST(Affine, ComposesInvertsAndRotates) {
  const Affine3 m = translation({1, 2, 3}) * rotation(normalized({1, 2, -1}), 0.8) * scaling({2, -0.5, 3});
  expect_near(m.inverse().point(m.point({5, -7, 11})), {5, -7, 11}, 1e-13);
  expect_near((m * m.inverse()).vector({1, 1, 1}), {1, 1, 1}, 1e-14);
  EXPECT_NEAR(m.determinant(), 2 * -0.5 * 3, 1e-14);
  expect_near(rotation({0, 0, 1}, kPi / 2).vector({1, 0, 0}), {0, 1, 0}, 1e-15);
  expect_near(m.point({1, 1, 1}),
              translation({1, 2, 3}).point(rotation(normalized({1, 2, -1}), 0.8).vector({2, -0.5, 3})), 1e-14);
}

TEST(Affine, NormalsStayNormalToSurfacesUnderAnyMapAndKeepTheirSide) {
  // The normal of a mapped triangle is the mapped normal, for non-uniform, mirrored and extreme scales alike.
  for (const Vec3 s : {Vec3{1, 2, 3}, Vec3{-1, 1, 1}, Vec3{1e-6, 1, 1e6}, Vec3{-2, -3, -4}}) {
    const Affine3 m = rotation(normalized({3, 1, 2}), 1.1) * scaling(s);
    const Vec3 u{1, 0.5, -0.25}, v{-0.3, 2, 1};
    const Vec3 mapped = m.normal(cross(u, v)), direct = cross(m.vector(u), m.vector(v));
    expect_near(mapped / length(direct), direct / length(direct), 1e-9);
  }
}

TEST(Affine, NestingSixtyFourTransformsKeepsItsDigits) {
  Affine3 down, up;
  Pcg32 rng(9);
  std::vector<Affine3> steps;
  for (int i = 0; i < 64; ++i)
    steps.push_back(translation({rng.uniform(), 10 * rng.uniform(), -rng.uniform()}) *
                    rotation(uniform_sphere({rng.uniform(), rng.uniform()}), 6 * rng.uniform()) *
                    scaling({1.1, 0.9, i % 2 ? -1.0 : 1.0}));
  for (const Affine3& s : steps) down = down * s;
  Vec3 p{1, 2, 3};
  for (size_t i = steps.size(); i-- > 0;) p = steps[i].point(p);
  EXPECT_LE(length(down.point({1, 2, 3}) - p), 1e-12 * length(p));
}

TEST(Box, GrowsAndKnowsEmpty) {
  Box3 box, other;
  EXPECT_TRUE(box.empty());
  box.grow(other);
  EXPECT_TRUE(box.empty());
  box.grow(Vec3{1, 2, 3});
  EXPECT_FALSE(box.empty());
  other.grow(Vec3{-1, 5, 0});
  box.grow(other);
  EXPECT_EQ(box.low, (Vec3{-1, 2, 0}));
  EXPECT_EQ(box.high, (Vec3{1, 5, 3}));
  EXPECT_EQ(box.center(), (Vec3{0, 3.5, 1.5}));
}

TEST(QuickAngle, IsTheExactOneWithin5e8) {
  double worst = 0;
  const auto off = [&](double y, double x) {
    worst = std::max(worst, std::fabs(quick_atan2(y, x) - std::atan2(y, x)));
  };
  Pcg32 rng(5);
  for (int i = 0; i < 100000; ++i) off(2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
  for (const double y : {-1.0, -1e-12, 0.0, 1e-300, 1.0})
    for (const double x : {-1.0, -1e-12, 1e-300, 1.0}) off(y, x);
  EXPECT_LT(worst, 5e-8);
  EXPECT_GT(worst, 1e-10);  // it is another function
  EXPECT_EQ(quick_atan2(0, 0), 0);
  for (const Dir d : directions()) {
    EXPECT_NEAR(quick_polar_angle(d), polar_angle(d), 5e-8);
  }
}

}  // namespace suite::vec_test
