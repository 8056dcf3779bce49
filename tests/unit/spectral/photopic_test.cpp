// Light as the eye weighs it, beside published integrals.
#include "spectral/photopic.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::photopic_test {
namespace {

// The integral of V is 106.857 nm (CIE 15:2018, table of tristimulus sums), and 683.002 lm/W its scale.
TEST(Photopic, AnEvenSpectrum) { EXPECT_NEAR(photopic(Curve::constant(1)), 683.002 * 0.106857, 0.01); }

TEST(Photopic, ALineAt555) {
  const Curve line({0.5549, 0.555, 0.5551}, {0, 1e4, 0}, Outside::zero);  // 1 W/sr
  EXPECT_NEAR(photopic(line), 683.002 * 0.9950, 0.5);
}

// A black body of 2042 K at the freezing point of platinum had 60 cd/cm2 by the old definition of the candela (BIPM,
// 1948): its radiance by Planck's law, in steps of 1 nm.
TEST(Photopic, TheOldCandela) {
  std::vector<double> um, radiance;
  for (int nm = 370; nm <= 800; ++nm) {
    const double x = nm * 1e-3, c1 = 1.191042972e8, c2 = 14387.76877, kelvin = 2041.4;
    um.push_back(x);
    radiance.push_back(c1 / (x * x * x * x * x) / (std::exp(c2 / (x * kelvin)) - 1));
  }
  EXPECT_NEAR(photopic(Curve(um, radiance, Outside::zero)), 6e5, 0.01 * 6e5);
}

TEST(Photopic, ASpectrumThatEndsWithinSightIsRefused) {
  EXPECT_THROW(photopic(Curve({0.45, 0.65}, {1, 1}, Outside::error)), Error);
}

// 683 lm/W at 555.016 nm for both eyes, by definition; the dark eye's maximum is at 507 nm.
TEST(Scotopic, MeetsTheBrightEyeAt555) {
  EXPECT_NEAR(scotopic_weight(0.555), 683, 0.01 * 683);
  EXPECT_NEAR(scotopic_weight(0.507), 1700, 0.01 * 1700);
  EXPECT_GT(scotopic_weight(0.507), scotopic_weight(0.49));
  EXPECT_EQ(scotopic_weight(0.8), 0);
  const Curve line({0.5069, 0.507, 0.5071}, {0, 1e4, 0}, Outside::zero);
  EXPECT_NEAR(scotopic(line), scotopic_weight(0.507), 1);
}

}  // namespace
}  // namespace suite::photopic_test
