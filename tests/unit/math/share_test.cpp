// Rounding of computed shares is taken off, and nothing else.
#include "math/share.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace suite::share_test {
namespace {

TEST(Share, RoundingIsTakenOff) {
  double mean = 0;  // of nine ones
  for (int i = 0; i < 9; ++i) mean += 1.0 / 9;
  const double beyond = std::nextafter(1.0, 2.0);
  for (const double one : {mean, beyond, 1 + 1e-9}) EXPECT_EQ(as_share(std::fmax(one, 1.0)), 1);
  for (const double none : {1 - beyond, -1e-9, -0.0, -std::numeric_limits<double>::denorm_min()})
    EXPECT_EQ(as_share(none), 0);
  for (const double within : {1e-300, 0.5, std::nextafter(1.0, 0.0)}) EXPECT_EQ(as_share(within), within);
}

TEST(Share, FaultsStay) {
  for (const double wrong : {-2e-9, 1 + 2e-9, -1.0, 2.0}) {
    EXPECT_EQ(as_share(wrong), wrong);
    EXPECT_FALSE(is_share(wrong)) << wrong;
  }
  EXPECT_FALSE(is_share(NAN));
  EXPECT_TRUE(is_share(1 + 7e-16));
}

}  // namespace
}  // namespace suite::share_test
