// Light through piles of parallel faces.
#include "transport/parallel_faces.h"

#include <gtest/gtest.h>

#include <vector>

namespace suite::test::parallel_faces_test {
namespace {

TEST(ParallelFaces, OneAndTwo) {
  const std::vector<double> one{0.2}, two{0.2, 0.3};
  EXPECT_DOUBLE_EQ(passed({}), 1);
  EXPECT_DOUBLE_EQ(passed(one), 0.8);
  EXPECT_NEAR(passed(two), 0.8 * 0.7 / (1 - 0.2 * 0.3), 1e-15);
  EXPECT_DOUBLE_EQ(passed(std::vector<double>{0.2, 1}), 0);
  EXPECT_DOUBLE_EQ(passed_within({}, 0), 1);
  EXPECT_DOUBLE_EQ(passed_within(one, 0), 0);
  EXPECT_DOUBLE_EQ(passed_within(one, 1), 0.8);
  EXPECT_DOUBLE_EQ(passed_within(one, 9), 0.8) << "what comes back has left";
  EXPECT_DOUBLE_EQ(passed_within(two, 1), 0);
  EXPECT_NEAR(passed_within(two, 3), 0.8 * 0.7, 1e-15);
  EXPECT_NEAR(passed_within(two, 4), 0.8 * 0.7 * (1 + 0.06), 1e-15);
}

TEST(ParallelFaces, MoreMeetingsBringAllOfIt) {
  const std::vector<double> many{0.04, 0.3, 0.04, 0.1, 0.0, 0.04, 0.2};
  double before = 0;
  for (int most = 7; most < 200; ++most) {
    const double now = passed_within(many, most);
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_NEAR(before, passed(many), 1e-12);
  // Nothing but the straight way, then one pair of neighbours that reflect: six pairs.
  double straight = 1, pairs = 0;
  for (const double r : many) straight *= 1 - r;
  for (size_t i = 0; i + 1 < many.size(); ++i) pairs += many[i] * many[i + 1];
  EXPECT_NEAR(passed_within(many, 8), straight, 1e-15);
  EXPECT_NEAR(passed_within(many, 9), straight * (1 + pairs), 1e-15);
}

}  // namespace
}  // namespace suite::test::parallel_faces_test
