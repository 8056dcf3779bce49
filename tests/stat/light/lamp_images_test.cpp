// The images of lamps are drawn as often as is said, for every one of them, and all together make 1.
#include <gtest/gtest.h>

#include <cmath>

#include "light/kinds/lamp_images.h"
#include "math/sampling.h"
#include "math/stats.h"

namespace suite::lamp_images_test {
namespace {

struct Case {
  const char* name;
  Periodic cell;
  Box3 lamps;
  Vec3 from;
};
std::vector<Case> cases() {
  return {{"in the cell", {{0, 0}, {10, 10}}, {{4, 4, 3}, {5, 6, 4}}, {2, 9, 0}},
          {"high above", {{0, 0}, {10, 10}}, {{4, 4, 3}, {5, 6, 4}}, {2, 9, 80}},
          {"far away, a long cell", {{-3, 5}, {70, 8}}, {{10, 5, 3}, {60, 13, 3}}, {1234, -777, 2}},
          {"beside a lamp at the corner", {{0, 0}, {1, 3}}, {{0, 0, 1}, {0, 0, 1}}, {0.01, -0.02, 1}}};
}

TEST(LampImages, FrequenciesFollowTheProbabilities) {
  // Significance 1e-4 over all cases; probabilities 5 % too high for every other image must be refused.
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const LampImages images(c.cell, c.lamps);
    constexpr int reach = 60;
    const auto cell_of = [&](double x, double low, double size) { return std::floor((x - low) / size); };
    const double own[2] = {cell_of(c.from.x, c.cell.low.x, c.cell.size.x),
                           cell_of(c.from.y, c.cell.low.y, c.cell.size.y)};
    std::vector<double> observed((2 * reach + 1) * (2 * reach + 1) + 1, 0.0), expected = observed;
    const uint64_t n = 1'000'000;
    Pcg32 random(3);
    for (uint64_t i = 0; i < n; ++i) {
      const LampImages::Image drawn = images.draw(c.from, random.uniform());
      EXPECT_NEAR(images.probability(c.from, drawn.shift), drawn.probability, 1e-9 * drawn.probability);
      const double x = std::round(drawn.shift.x / c.cell.size.x) - own[0],
                   y = std::round(drawn.shift.y / c.cell.size.y) - own[1];
      const bool near = std::fabs(x) <= reach && std::fabs(y) <= reach;
      observed[near ? static_cast<size_t>((x + reach) * (2 * reach + 1) + y + reach) : observed.size() - 1] += 1;
    }
    double sum = 0;
    for (int x = -reach; x <= reach; ++x)
      for (int y = -reach; y <= reach; ++y) {
        const double p = images.probability(c.from, {(own[0] + x) * c.cell.size.x, (own[1] + y) * c.cell.size.y, 0});
        EXPECT_GT(p, 0);
        sum += p;
        expected[static_cast<size_t>((x + reach) * (2 * reach + 1) + y + reach)] = p * static_cast<double>(n);
      }
    EXPECT_LT(sum, 1);
    expected.back() = (1 - sum) * static_cast<double>(n);
    EXPECT_GT(chi_square_test(observed, expected, 10), 1e-4 / 4);
    std::vector<double> wrong = expected;
    for (size_t i = 0; i < wrong.size(); ++i) wrong[i] *= i % 2 ? 1.05 : 0.95;
    EXPECT_LT(chi_square_test(observed, wrong, 10), 1e-4);
  }
}

TEST(LampImages, AllTogetherMakeOne) {
  // Ring by ring, cells of a ring alike: the sum of the first K rings of a softness s leaves s / (K + s) of the rest.
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const LampImages images(c.cell, c.lamps);
    const Vec3 whole =
        images.whole({c.from.x - c.cell.low.x - 0.5 * c.cell.size.x, c.from.y - c.cell.low.y - 0.5 * c.cell.size.y, 0});
    const double sx = std::round(std::max(c.cell.size.x, c.cell.size.y) / c.cell.size.x),
                 sy = std::round(std::max(c.cell.size.x, c.cell.size.y) / c.cell.size.y);
    const auto p = [&](double x, double y) {
      return images.probability(c.from, whole + Vec3{x * c.cell.size.x, y * c.cell.size.y, 0});
    };
    double sum = 0, before = 0;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y) sum += p(x, y);
    for (double m = 2; m <= 20000; ++m) {
      const double rx = 1 + (m - 1) * sx, ry = 1 + (m - 1) * sy, qx = 1 + (m - 2) * sx, qy = 1 + (m - 2) * sy;
      before = sum;
      sum += p(rx, -ry) * ((2 * rx + 1) * (2 * ry + 1) - (2 * qx + 1) * (2 * qy + 1));
      EXPECT_EQ(p(rx, ry), p(-rx, 0));
      EXPECT_EQ(p(0, -ry), p(rx, 0));
    }
    // What is left of a tail 1 / k^2: the last ring's share times its number.
    EXPECT_NEAR(sum + 20000 * (sum - before), 1, 1e-3);
    EXPECT_LT(sum, 1);
  }
}

}  // namespace
}  // namespace suite::lamp_images_test
