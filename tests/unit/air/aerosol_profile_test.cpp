#include "air/aerosol_profile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace suite::aerosol_profile_test {
namespace {

TEST(AerosolProfile, VisibilityIsKoschmieders) {
  // Contrast 0.02 over 23 km: 3.912 / 23 per km, of which the molecules take 0.01159.
  EXPECT_NEAR(visibility_extinction(23000), (3.912 / 23 - 0.01159) / 1000, 1e-12);
  EXPECT_THROW(visibility_extinction(0), Error);
  EXPECT_THROW(visibility_extinction(-5), Error);
  EXPECT_THROW(visibility_extinction(338000), Error);
}

TEST(AerosolProfile, IsLowtransTable) {
  // LOWTRAN 7, block data PRFDTA, 1/km: 23 km visibility, spring and summer; fall and winter.
  const AerosolProfile summer(23000), winter(23000, AerosolProfile::Season::fall_winter);
  EXPECT_NEAR(summer.extinction(0), 1.58e-4, 1e-6);
  EXPECT_NEAR(summer.extinction(2000), 6.21e-5, 1e-10);
  EXPECT_NEAR(summer.extinction(3000), 3.46e-5, 1e-10);
  EXPECT_NEAR(winter.extinction(3000), 2.72e-5, 1e-10);
  EXPECT_NEAR(summer.extinction(20000), 5.89e-7, 1e-12);
  EXPECT_NEAR(winter.extinction(20000), 4.23e-7, 1e-12);
  EXPECT_EQ(summer.extinction(2e5), 0);
  // Halfway between two heights: their geometric mean.
  EXPECT_NEAR(summer.extinction(2500), std::sqrt(6.21e-5 * 3.46e-5), 1e-10);
  EXPECT_EQ(AerosolProfile::region(1999), AerosolProfile::Region::boundary);
  EXPECT_EQ(AerosolProfile::region(5000), AerosolProfile::Region::free_troposphere);
  EXPECT_EQ(AerosolProfile::region(15000), AerosolProfile::Region::stratosphere);
}

TEST(AerosolProfile, GrowsHazierWithoutJumps) {
  double before = AerosolProfile(336000).depth();
  for (double visibility = 300000; visibility > 2000; visibility *= 0.97) {
    const double depth = AerosolProfile(visibility).depth();
    EXPECT_GE(depth, before * 0.999) << visibility;
    EXPECT_LT(depth, before * 1.25 + 0.01) << visibility;
    before = depth;
  }
}

TEST(AerosolProfile, DepthIsTheIntegralOfExtinction) {
  for (const AerosolProfile& profile :
       {AerosolProfile(23000), AerosolProfile(5000), AerosolProfile::exponential(0.3, 2000)}) {
    for (const auto& [low, high] : {std::pair<double, double>{0, 1e5}, {500, 2300}, {1999, 2001}, {9000, 40000}}) {
      double sum = 0;
      const int n = 100000;
      for (int i = 0; i < n; ++i) sum += profile.extinction(low + (high - low) * (i + 0.5) / n) * (high - low) / n;
      EXPECT_NEAR(profile.depth(low, high) / sum, 1, 1e-5) << low;
    }
    EXPECT_NEAR(profile.depth(), profile.depth(0, 3000) + profile.depth(3000, 1e5), 1e-12);
  }
  EXPECT_NEAR(AerosolProfile(23000).with_depth(0.2).depth(), 0.2, 1e-12);
  EXPECT_NEAR(AerosolProfile::exponential(0.3, 2000).depth(0, 1e6), 0.3, 1e-12);
  EXPECT_THROW(AerosolProfile::exponential(-1, 2000), Error);
  EXPECT_THROW(AerosolProfile::exponential(0.3, 0), Error);
  EXPECT_THROW(AerosolProfile(23000).with_depth(-0.1), Error);
}

}  // namespace
}  // namespace suite::aerosol_profile_test
