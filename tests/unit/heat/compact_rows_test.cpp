// Rows in two bytes a number: what is kept exactly, and how far the rest is off.
#include "heat/compact_rows.h"

#include <gtest/gtest.h>

#include <cmath>

namespace suite::compact_rows_test {
namespace {

TEST(CompactRows, KeepsWhatIsEvenAndTheLeastExactly) {
  const CompactRows rows(std::vector<float>{0.1f, 0.1f, 0.1f, 0, 371.7f, 950.3f}, 3);
  EXPECT_EQ(rows.rows(), 2u);
  for (size_t k = 0; k < 3; ++k) EXPECT_EQ(rows.at(0, k), double{0.1f});
  EXPECT_EQ(rows.at(1, 0), 0);
  EXPECT_NEAR(rows.at(1, 2), 950.3, 1e-4);
}

TEST(CompactRows, IsOffByHalfAStepAtMost) {
  std::vector<float> values;
  for (int k = 0; k < 1000; ++k) values.push_back(static_cast<float>(300 * std::sin(0.37 * k) - 40));
  const CompactRows rows(values, 1000);
  const std::vector<float> back = rows.floats();
  double worst = 0;
  for (size_t k = 0; k < values.size(); ++k) worst = std::fmax(worst, std::fabs(double{back[k]} - double{values[k]}));
  EXPECT_LT(worst, 600.0 / 131070 * 1.02);
  EXPECT_GT(worst, 600.0 / 131070 / 2);  // two bytes are not more
}

TEST(CompactRows, WhatIsNotFiniteStaysSo) {
  const CompactRows rows(std::vector<float>{1, INFINITY, 2, 1, NAN, 2}, 3);
  EXPECT_FALSE(std::isfinite(rows.at(0, 1)));
  EXPECT_FALSE(std::isfinite(rows.at(1, 0)));
}

}  // namespace
}  // namespace suite::compact_rows_test
