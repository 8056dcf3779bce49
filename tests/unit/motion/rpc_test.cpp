// RPC00B: coefficients fitted to a pinhole camera see other places where the camera itself sees them (its projection is
// the closed form), and what no quotient of polynomials follows is said.
#include "motion/rpc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace suite::rpc_test {
namespace {

const SceneFrame kFrame(Geodetic{47, 179.9995, 300});  // the picture crosses the meridian of 180 degrees

// A camera at (0, -600, 800) that looks at the origin; focal length in pixels.
struct Pinhole {
  Vec3 at{0, -600, 800};
  Vec3 forward = normalized(Vec3{0, 600, -800}), right{1, 0, 0}, down = cross(forward, right);
  double focal = 900;
  Vec2 image(Vec3 p) const {
    const Vec3 d = p - at;
    return {320 + focal * dot(d, right) / dot(d, forward), 240 + focal * dot(d, down) / dot(d, forward)};
  }
};

SightedPlace seen(Vec3 p, Vec2 at) { return {kFrame.geodetic_from_enu(p), at.y, at.x}; }

TEST(Rpc, FollowsAPinhole) {
  const Pinhole camera;
  std::vector<SightedPlace> places;
  for (int x = -10; x <= 10; ++x)
    for (int y = -10; y <= 10; ++y)
      for (int z = 0; z < 5; ++z) {
        const Vec3 p{30.0 * x, 30.0 * y, 20.0 * z};
        places.push_back(seen(p, camera.image(p)));
      }
  const auto rpc = fit_rpc(places);
  ASSERT_TRUE(rpc);
  EXPECT_LT(rpc->largest, 0.01);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  double mirrored = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p{-300 + 600 * u(random), -300 + 600 * u(random), 80 * u(random)};
    const Vec2 exact = camera.image(p), found = rpc->image(kFrame.geodetic_from_enu(p));
    EXPECT_NEAR(found.x, exact.x, 0.02);
    EXPECT_NEAR(found.y, exact.y, 0.02);
    mirrored = std::max(mirrored, std::fabs(rpc->image(kFrame.geodetic_from_enu({-p.x, p.y, p.z})).x - exact.x));
  }
  EXPECT_GT(mirrored, 100);  // the comparison can fail
}

TEST(Rpc, SaysWhatItDoesNotFollow) {
  EXPECT_FALSE(fit_rpc(std::vector<SightedPlace>(79)));
  // Columns that jump from line to line.
  std::vector<SightedPlace> places;
  std::mt19937 random(6);
  std::normal_distribution<double> jitter(0, 5);
  for (int y = 0; y < 30; ++y) {
    const double off = jitter(random);
    for (int x = 0; x < 30; ++x) places.push_back(seen({1.0 * x, 1.0 * y, 0.1 * (x + y)}, {x + off, 1.0 * y}));
  }
  const auto rpc = fit_rpc(places);
  EXPECT_TRUE(!rpc || rpc->rms > 1);
}

}  // namespace
}  // namespace suite::rpc_test
