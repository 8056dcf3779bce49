// Screw interpolation against its closed form, from 1e-9 rad to a full turn, and the same motion written in the scene's
// frame, in an Earth-centred frame and in the camera's: one pose to 1e-8 m.
#include <gtest/gtest.h>

#include <vector>

#include "math/dualquat.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "support/screw.h"

namespace suite::sclerp_test {

namespace {

using namespace test;

Dir any_axis(Pcg32& rng) { return uniform_sphere({rng.uniform(), rng.uniform()}); }

}  // namespace

TEST(Sclerp, FollowsTheScrewFromNothingToHalfATurn) {
  Pcg32 rng(1);
  for (const double angle :
       {0.0, 1e-15, 1e-13, 1e-12, 1e-9, 1e-6, 1e-3, 0.5, 2.0, 3.0, kPi - 1e-3, kPi - 1e-6, kPi - 1e-9})
    for (int t = 0; t < 20; ++t) {
      const Dir axis = any_axis(rng);
      // The foot stays within reach for tiny angles too: a 1 km arm.
      const Screw screw{axis, cross(axis, any_axis(rng)) * 1000, angle, 300 * (rng.uniform() - 0.5)};
      const Pose start{quat_about(any_axis(rng), 6 * rng.uniform()), any_axis(rng) * 500};
      for (const double s : {0.0, 1e-6, 0.25, 0.5, 0.9, 1.0, -0.5, 1.5}) {
        const Pose expected = screw.at(s) * start, got = sclerp(start, screw.at(1) * start, s);
        EXPECT_LT(apart(expected, got), 1e-9) << angle << " " << s;
      }
    }
}

TEST(Sclerp, EndsAreExactAndHalfATurnTakesOneOfTheTwoShortestWays) {
  Pcg32 rng(2);
  for (int t = 0; t < 200; ++t) {
    const Dir axis = t < 3 ? Dir{t == 0 ? 1.0 : 0, t == 1 ? 1.0 : 0, t == 2 ? 1.0 : 0} : any_axis(rng);
    const Screw screw{axis, any_axis(rng) * 10, kPi, 5};
    const Pose a{quat_about(any_axis(rng), 6 * rng.uniform()), any_axis(rng) * 100}, b = screw.at(1) * a;
    EXPECT_LT(apart(sclerp(a, b, 0), a), 1e-10);
    EXPECT_LT(apart(sclerp(a, b, 1), b), 1e-10);
    const Screw other{axis, screw.foot, -kPi, 5};
    const Pose middle = sclerp(a, b, 0.5);
    EXPECT_LT(std::fmin(apart(middle, screw.at(0.5) * a), apart(middle, other.at(0.5) * a)), 1e-9);
  }
}

TEST(Sclerp, AFullTurnIsNoTurnButAStraightLine) {
  // Orientations a whole turn apart are one orientation; the way between the places is straight.
  const Pose a{quat_about({0, 0, 1}, 0.3), {1, 2, 3}};
  for (const double turn : {2 * kPi, -2 * kPi, 4 * kPi}) {
    const Pose b{quat_about({0, 0, 1}, 0.3 + turn), {101, 2, 3}};
    const Pose middle = sclerp(a, b, 0.5);
    EXPECT_LT(apart(middle, {a.rotation, {51, 2, 3}}), 1e-11);
  }
}

TEST(Sclerp, IsOneMotionInEveryFrame) {
  Pcg32 rng(3);
  for (const double angle : {0.0, 1e-12, 1e-9, 1e-3, 0.7, 3.0, kPi - 1e-9, kPi, 2 * kPi})
    for (int t = 0; t < 50; ++t) {
      const Screw screw{t % 3 ? any_axis(rng) : Dir{0, 0, 1}, any_axis(rng) * 200, angle, 100 * rng.uniform()};
      const Pose a{quat_about(any_axis(rng), 6 * rng.uniform()), any_axis(rng) * 1000}, b = screw.at(1) * a;
      const Pose earth{quat_about(any_axis(rng), 6 * rng.uniform()), any_axis(rng) * 6378137.0}, camera = a.inverse();
      for (const double s : {0.1, 0.5, 0.8}) {
        const Pose enu = sclerp(a, b, s);
        EXPECT_LT(apart(earth * enu, sclerp(earth * a, earth * b, s)), 1e-8) << angle;
        EXPECT_LT(apart(camera * enu, sclerp(camera * a, camera * b, s)), 1e-8) << angle;
      }
    }
}

TEST(Sclerp, ForwardsAndBackwardsIsTheSameWay) {
  Pcg32 rng(4);
  for (int t = 0; t < 100; ++t) {
    const Screw screw{any_axis(rng), any_axis(rng) * 100, 3 * rng.uniform(), 10};
    const Pose a{quat_about(any_axis(rng), 6 * rng.uniform()), any_axis(rng) * 100}, b = screw.at(1) * a;
    EXPECT_LT(apart(sclerp(a, b, 0.3), sclerp(b, a, 0.7)), 1e-10);
  }
}

TEST(Pose, MatricesQuaternionsAndDualQuaternionsAgree) {
  Pcg32 rng(5);
  for (int t = 0; t < 300; ++t) {
    // Half turns make the trace of the matrix -1, where a naive conversion divides by nothing.
    const double angle = t % 3 == 0 ? kPi : t % 3 == 1 ? 1e-8 : 6 * rng.uniform();
    const Pose p{quat_about(any_axis(rng), angle), any_axis(rng) * 50};
    EXPECT_LT(apart({quat_from_matrix(p.affine()), p.translation}, p), 1e-12);
    EXPECT_LT(apart(DualQuat::from(p).pose(), p), 1e-12);
    EXPECT_LT(apart(p * p.inverse(), {}), 1e-12);
    EXPECT_LT(length(p.affine().point({1, 2, 3}) - p.point({1, 2, 3})), 1e-13);
  }
}

}  // namespace suite::sclerp_test
