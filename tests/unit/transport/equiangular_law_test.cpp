// Equiangular distances: densities are those of what is drawn, and the light of a point over them does not vary.
#include "transport/equiangular_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/sampling.h"

namespace suite::equiangular_law_test {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

TEST(EquiangularLaw, DrawsByItsDensity) {
  for (const double length : {3.0, 40.0, kForever}) {
    const EquiangularLaw law({0, 0, 0}, {1, 0, 0}, length, {7, 2, 0});
    // Distribution function by the midpoint rule up to what was drawn: u itself.
    for (const double u : {0.1, 0.35, 0.5, 0.8, 0.99}) {
      const double t = law.draw(u);
      ASSERT_GT(t, 0);
      ASSERT_LT(t, length);
      double sum = 0;
      constexpr int kSteps = 20000;
      for (int i = 0; i < kSteps; ++i) sum += law.density((i + 0.5) * t / kSteps) * t / kSteps;
      EXPECT_NEAR(sum, u, 1e-6) << length;
    }
  }
}

TEST(EquiangularLaw, LightOfAPointDoesNotVary) {
  const Vec3 lamp{7, 2, 0};
  const EquiangularLaw law({0, 0, 0}, {1, 0, 0}, 30, lamp);
  for (int i = 0; i < 32; ++i) {
    const double t = law.draw((i + 0.5) / 32);
    const Vec3 to = lamp - Vec3{t, 0, 0};
    EXPECT_NEAR(1 / (dot(to, to) * law.density(t)), law.worth(), 1e-12 * law.worth());
  }
}

TEST(EquiangularLaw, IsOfNoUseThroughThePointItself) {
  EXPECT_EQ(EquiangularLaw({0, 0, 0}, {1, 0, 0}, 30, {7, 0, 0}).worth(), 0);
  EXPECT_EQ(EquiangularLaw().density(1), 0);
  // A point behind the ray's beginning is seen under a small angle, and has one.
  const EquiangularLaw behind({0, 0, 0}, {1, 0, 0}, kForever, {-5, 1, 0});
  EXPECT_NEAR(behind.worth(), std::atan2(1, 5), 1e-12);
}

}  // namespace
}  // namespace suite::equiangular_law_test
