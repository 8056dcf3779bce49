// Twinkling of stars: Young's figure, its laws, and a factor whose moments are those that it claims.
#include "light/night/scintillation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/far_points.h"
#include "light/kinds/clear_sky.h"
#include "math/stats.h"

namespace suite::test::scintillation_test {
namespace {

// 0.09 D^(-2/3) / sqrt(2 t): 5 cm, zenith, 1 s, sea level, by hand.
TEST(Scintillation, YoungsFormula) {
  EXPECT_NEAR(scintillation_index(0.05, 1, 0, 1), 0.0218, 5e-5);
  const double one = scintillation_index(0.05, 1, 0, 1);
  EXPECT_NEAR(scintillation_index(0.4, 1, 0, 1) / one, 0.25, 1e-12);
  EXPECT_NEAR(scintillation_index(0.05, 2, 0, 1) / one, std::pow(2, 1.75), 1e-12);
  EXPECT_NEAR(scintillation_index(0.05, 1, 8000, 1) / one, std::exp(-1), 1e-12);
  EXPECT_NEAR(scintillation_index(0.05, 1, 0, 4) / one, 0.5, 1e-12);
  EXPECT_EQ(scintillation_index(0.05, 1, 0, 1e-6), scintillation_index(0.05, 1, 0, 0.01));
}

// 20 000 draws: 4.5 standard errors.
TEST(Scintillation, FactorsHaveItsMoments) {
  FarPoints sky;
  sky.scintillation = 7;
  sky.points.resize(20001);
  sky.points[20000].twinkles = false;
  FarPoints::Watched how{0.05, 0, 1, {}, {0, 0, 1}};
  const double index = scintillation_index(0.05, air_mass(0), 0, 1);
  RunningStats seen;
  for (size_t i = 0; i < 20000; ++i) seen.add(sky.scintillation_of(i, how));
  EXPECT_NEAR(seen.mean(), 1, 4.5 * index / std::sqrt(20000.0));
  EXPECT_NEAR(std::sqrt(seen.variance()) / index, 1, 4.5 / std::sqrt(40000.0));
  EXPECT_EQ(sky.scintillation_of(20000, how), 1) << "a planet";
  EXPECT_EQ(sky.scintillation_of(3, how), sky.scintillation_of(3, how));
  const double before = sky.scintillation_of(3, how);
  how.begin = 1, how.end = 2;
  EXPECT_NE(sky.scintillation_of(3, how), before) << "another exposure";
  how.aperture = 0;
  EXPECT_EQ(sky.scintillation_of(3, how), 1);
  // In orbit nothing twinkles.
  FarPoints::Watched orbit{0.05, 0, 1, {0, 0, 400e3}, {0, 0, 1}};
  EXPECT_NEAR(sky.scintillation_of(3, orbit), 1, 1e-15);
}

}  // namespace
}  // namespace suite::test::scintillation_test
