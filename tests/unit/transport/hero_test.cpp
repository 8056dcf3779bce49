// The mean over hero wavelengths weighs what is drawn so that sums come out right, whichever hero draws.
#include "transport/path/hero.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <utility>

namespace suite::test::hero_test {
namespace {

constexpr size_t kHeroes = 3, kValues = 5;
constexpr std::array<double, kHeroes> kP{0.5, 0.3, 0.2};
using Shape = std::array<float, kValues>;

std::array<Shape, kHeroes> draw_shapes(std::mt19937& random) {
  std::array<Shape, kHeroes> shapes;
  for (Shape& shape : shapes) {
    float sum = 0;
    for (float& p : shape) sum += p = std::uniform_real_distribution<float>(0.01f, 1)(random);
    for (float& p : shape) p /= sum;
  }
  return shapes;
}
std::array<float, kHeroes> at(const std::array<Shape, kHeroes>& shapes, size_t value) {
  return {shapes[0][value], shapes[1][value], shapes[2][value]};
}

// The sum of f over all pairs of two choices, as the expectation of its estimate over heroes and choices. shared: it is
// divided by A, too.
double expectation(const std::array<Shape, kHeroes>& one, const std::array<Shape, kHeroes>& two, bool shared) {
  double sum = 0;
  for (size_t h = 0; h < kHeroes; ++h)
    for (size_t i = 0; i < kValues; ++i)
      for (size_t j = 0; j < kValues; ++j) {
        const double density = double{one[h][i]} * double{two[h][j]};
        if (density == 0) continue;  // never drawn
        HeroDensities<8> r;
        r.start(kHeroes);
        r.take(kHeroes, at(one, i), one[h][i]);
        double A = r.mean(kP);
        r.divide(kHeroes, A);
        r.take(kHeroes, at(two, j), two[h][j]);
        A *= r.mean(kP);
        const double f = 1 + static_cast<double>(i) + 10 * static_cast<double>(j);
        sum += kP[h] * density * f / (density * (shared ? A : 1));
      }
  return sum;
}

TEST(HeroDensities, SumsAreRightWhicheverHeroDraws) {
  const double f = kValues * kValues * 23;  // of 1 + i + 10 j
  std::mt19937 random(5);
  for (int n = 0; n < 20; ++n) {
    auto one = draw_shapes(random);
    const auto two = draw_shapes(random);
    for (size_t h = 0; h < kHeroes; ++h) {  // every hero misses a value that others draw
      const float left = 1 - std::exchange(one[h][h], 0.0f);
      for (float& p : one[h]) p /= left;
    }
    EXPECT_NEAR(expectation(one, two, true), f, 1e-4 * f);
    EXPECT_LT(expectation(one, two, false), 0.95 * f);  // negative control
  }
}

TEST(HeroDensities, MeansOfWhatFollowsAreThoseAfterTakingIt) {
  std::mt19937 random(6);
  const auto shapes = draw_shapes(random), next = draw_shapes(random);
  HeroDensities<8> r, taken, set;
  r.start(kHeroes);
  r.take(kHeroes, at(shapes, 2), shapes[1][2]);
  taken = r;
  taken.take(kHeroes, at(next, 3), next[1][3]);
  set.set(kHeroes, r, at(next, 3), next[1][3]);
  const double own = double{next[1][3]};
  EXPECT_NEAR(r.mean(kP, at(next, 3)), taken.mean(kP) * own, 1e-12);
  EXPECT_NEAR(set.mean(kP), taken.mean(kP), 1e-12);
  const std::array<double, kHeroes> share{0.5, 0.5, 0.5};
  EXPECT_NEAR(r.mean(kP, at(next, 3), share), 0.5 * taken.mean(kP) * own, 1e-12);
  EXPECT_EQ(taken[1], r[1]);  // the one that draws
}

}  // namespace
}  // namespace suite::test::hero_test
