// The light tree draws lamps as often as it says, says so for every lamp, and misses none that can reach the place.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "light/light_tree.h"
#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"

namespace suite::light_tree_test {
namespace {

std::vector<LightBounds> random_lights(size_t n, uint64_t seed) {
  Pcg32 random(seed);
  std::vector<LightBounds> lights;
  for (size_t i = 0; i < n; ++i) {
    LightBounds b;
    const Vec3 p{20 * random.uniform(), 20 * random.uniform(), 5 * random.uniform()},
        s{random.uniform(), random.uniform(), random.uniform()};
    b.box = {p, p + s * 0.3};
    b.axis = uniform_sphere({random.uniform(), random.uniform()});
    b.cone = random.uniform() < 0.2 ? kPi : 0.3 * random.uniform();
    b.spread = 0.2 + random.uniform() * (kPi / 2 - 0.2);
    b.power = std::exp(5 * random.uniform());
    b.both_sides = random.uniform() < 0.2;
    lights.push_back(b);
  }
  return lights;
}

std::vector<LightReceiver> receivers() {
  return {{{10, 10, 1}, {0, 0, 1}, false},
          {{-30, 5, 2}, {1, 0, 0}, false},
          {{10, 3, 40}, {0, 0, -1}, true},
          {{4, 4, 4}, {}, false}};
}

// Street lamps of three kinds (everywhere alike, with a profile, a spot) and lit windows on a plane, some very weak.
struct Town {
  std::vector<LightBounds> lights;
  std::vector<LightProfile> profiles;
};
Town town(size_t n, double size, uint64_t seed) {
  Town t;
  LightProfile alike, down{};
  alike.fill(1);
  for (size_t i = 16; i < 32; ++i) down[i] = 0.2f + 0.05f * static_cast<float>(i - 16);
  t.profiles = {alike, down};
  Pcg32 random(seed);
  for (size_t i = 0; i < n; ++i) {
    LightBounds b;
    const Vec3 p{size * (random.uniform() - 0.5), size * (random.uniform() - 0.5), 4 + 6 * random.uniform()};
    b.box = {p, p};
    b.power = i % 5 == 4 ? 1e-9 : std::exp(3 * random.uniform());
    b.axis = {0, 0, -1};
    if (i % 4 == 0) b.cone = kPi, b.spread = 0.01, b.profile = 0;
    if (i % 4 == 1) b.cone = kPi / 2, b.spread = 0.01, b.profile = 1;
    if (i % 4 == 2) b.cone = 0.7, b.spread = 0.01, b.profile = 0;
    if (i % 4 == 3) b.box.high = p + Vec3{1, 0, 1}, b.axis = {0, i % 8 == 3 ? 1.0 : -1.0, 0};
    t.lights.push_back(b);
  }
  return t;
}

// Family-wise 1e-4 over the receivers of both trees; a claim that is 2 % off for every second lamp must be refused.
void expect_frequencies(const LightTree& tree) {
  const size_t lamps = tree.size();
  for (const LightReceiver& at : receivers()) {
    std::vector<double> observed(lamps + 1, 0.0), expected, wrong;
    const uint64_t n = 2'000'000;
    Pcg32 random(7);
    for (uint64_t i = 0; i < n; ++i) {
      const auto c = tree.sample(at, random.uniform());
      observed[c ? c->light : lamps] += 1;
      if (c && i % 1000 == 0) {
        EXPECT_NEAR(c->probability, tree.probability(at, c->light), 1e-12);
      }
    }
    double sum = 0;
    for (uint32_t i = 0; i < lamps; ++i) sum += tree.probability(at, i);
    for (uint32_t i = 0; i < lamps; ++i) expected.push_back(static_cast<double>(n) * tree.probability(at, i));
    expected.push_back(static_cast<double>(n) * std::max(0.0, 1 - sum));
    EXPECT_LE(sum, 1 + 1e-9);
    EXPECT_GT(chi_square_test(observed, expected, 10), 1e-4 / 8);
    wrong = expected;
    double total = 0;
    for (size_t i = 0; i < wrong.size(); ++i) wrong[i] *= i % 2 ? 1.02 : 0.98, total += wrong[i];
    for (double& w : wrong) w *= static_cast<double>(n) / total;
    EXPECT_LT(chi_square_test(observed, wrong, 10), 1e-6);
  }
}

TEST(LightTree, FrequenciesFollowTheProbabilities) { expect_frequencies(LightTree(random_lights(60, 1))); }
TEST(LightTree, FrequenciesOfProfilesAndWindowsFollowToo) {
  const Town t = town(60, 30, 18);
  expect_frequencies(LightTree(t.lights, t.profiles));
}

TEST(LightTree, EveryLampThatReachesThePlaceHasAChance) {
  // Points of the boxes, directions within cone and spread, before the receiver: whoever can send must be drawable.
  const std::vector<LightBounds> lights = random_lights(300, 2);
  const LightTree tree(lights);
  Pcg32 random(3);
  size_t reaching = 0, silent = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    const auto i = static_cast<uint32_t>(random.uniform() * 300);
    const LightBounds& b = lights[i];
    const Vec3 s = b.box.size(),
               p = b.box.low + Vec3{s.x * random.uniform(), s.y * random.uniform(), s.z * random.uniform()};
    LightReceiver at{{40 * random.uniform() - 10, 40 * random.uniform() - 10, 10 * random.uniform() - 2},
                     uniform_sphere({random.uniform(), random.uniform()}),
                     trial % 3 == 0};
    const Vec3 to = p - at.position;
    const double d = length(to), off = angle_between(b.axis, -to / d);
    const bool sends = off < b.cone + b.spread || (b.both_sides && kPi - off < b.cone + b.spread);
    const double cosine = dot(to, at.normal) / d;
    if (!sends || (at.two_sided ? cosine == 0 : cosine <= 0)) {
      ++silent;
      continue;
    }
    ++reaching;
    EXPECT_GT(tree.probability(at, i), 0) << i << " off " << off;
  }
  EXPECT_GT(reaching, 10000u);
  EXPECT_GT(silent, 10000u);
}

// Headlights on four streets around a place on the ground: most of them look elsewhere, and are drawn the less.
TEST(LightTree, LampsThatLookElsewhereAreDrawnLessAmidThem) {
  Pcg32 random(5);
  std::vector<LightBounds> lights;
  for (int i = 0; i < 64; ++i) {
    const double along = 80 * random.uniform() - 40, side = i % 2 ? 2 : -2;
    LightBounds b;
    const Vec3 p = i % 4 < 2 ? Vec3{side, along, 0.7} : Vec3{along, side, 0.7};
    b.box = {p, p};
    b.axis = i % 4 < 2 ? Dir{0, side > 0 ? 1.0 : -1.0, 0} : Dir{side > 0 ? -1.0 : 1.0, 0, 0};
    b.spread = 0.5;
    b.power = 1;
    lights.push_back(b);
  }
  const LightTree tree(lights);
  std::vector<double> relative;
  for (int k = 0; k < 400; ++k) {
    const LightReceiver at{{20 * random.uniform() - 10, 20 * random.uniform() - 10, 0}, {0, 0, 1}, false};
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) {
      const Vec3 to = lights[i].box.low - at.position;
      const double d = length(to);
      if (angle_between(lights[i].axis, -to / d) >= lights[i].spread) continue;
      const double sent = to.z / (d * d * d);
      sum += sent, squares += sent * sent / tree.probability(at, i);
    }
    if (sum > 0) relative.push_back(squares / (sum * sum) - 1);
  }
  // Variance of one draw by the square of its mean; a walk that knows nothing of clusters around the place has 5.4.
  std::sort(relative.begin(), relative.end());
  const double median = relative[relative.size() / 2];
  std::printf("relative variance of a draw: median %.3f, upper tenth %.3f, of %zu places\n", median,
              relative[relative.size() * 9 / 10], relative.size());
  EXPECT_GT(relative.size(), 300u);
  EXPECT_LT(median, 1.5);
}

TEST(LightTree, SeveralNumbersDrawWhatEachDraws) {
  const Town t = town(400, 150, 11);
  const LightTree tree(t.lights, t.profiles);
  Pcg32 random(12);
  size_t drawn = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    const LightReceiver at{{150 * random.uniform() - 75, 150 * random.uniform() - 75, 12 * random.uniform()},
                           uniform_sphere({random.uniform(), random.uniform()}),
                           trial % 2 == 0};
    std::array<double, 4> u;
    for (double& x : u) x = random.uniform();
    std::array<std::optional<LightTree::Choice>, 4> all;
    tree.sample(at, u, all);
    for (size_t k = 0; k < 4; ++k) {
      const auto one = tree.sample(at, u[k]);
      ASSERT_EQ(one.has_value(), all[k].has_value());
      if (!one) continue;
      ++drawn;
      EXPECT_EQ(one->light, all[k]->light);
      EXPECT_EQ(one->probability, all[k]->probability);
      EXPECT_NEAR(one->probability, tree.probability(at, one->light), 1e-14);
    }
  }
  EXPECT_GT(drawn, 10000u);
}

// Single precision knows places 100 km apart to a centimetre only: lamps at the horizon, and near, must stay drawable.
TEST(LightTree, RoundingHidesNoLamp) {
  for (const double size : {100.0, 2e5}) {
    const Town t = town(300, size, 15);
    const LightTree tree(t.lights, t.profiles);
    Pcg32 random(16);
    size_t reaching = 0;
    for (int trial = 0; trial < 100000; ++trial) {
      const auto i = static_cast<uint32_t>(random.uniform() * 300);
      const LightBounds& b = t.lights[i];
      const Vec3 s = b.box.size(), p = b.box.low + s * random.uniform();
      // From close by to the other end, with the lamp just above the horizon.
      const Dir to = uniform_sphere({random.uniform(), random.uniform()});
      const double d = std::exp(std::log(1e-3) + random.uniform() * std::log(size * 1e3));
      const Dir side = normalized(cross(to, uniform_sphere({random.uniform(), random.uniform()})));
      const LightReceiver at{p - to * d, normalized(side + to * std::exp(-14 * random.uniform()))};
      const double off = angle_between(b.axis, -to);
      // Profiles and spots send nothing outside of their cones.
      if (dot(to, at.normal) <= 0 || off >= b.cone + (b.profile < 0 ? b.spread : 0)) continue;
      ++reaching;
      EXPECT_GT(tree.probability(at, i), 0) << i << " at " << d << " m of " << size << ", off " << off;
    }
    EXPECT_GT(reaching, 20000u);
  }
}

// Lamps that shine everywhere alike, seen from the ground and from walls amid them: drawn nearly by what they send.
TEST(LightTree, PointsAreDrawnByWhatTheySend) {
  std::vector<LightBounds> lights;
  LightProfile alike;
  alike.fill(1);
  Pcg32 random(17);
  for (int i = 0; i < 220; ++i) {
    const Vec3 p{200 * random.uniform() - 100, 200 * random.uniform() - 100, 4 + 10 * random.uniform()};
    lights.push_back({{p, p}, {0, 0, -1}, kPi, 0.01, 1, false, 0});
  }
  const LightTree tree(lights, {alike});
  std::vector<double> relative;
  for (int k = 0; k < 400; ++k) {
    const LightReceiver at{{160 * random.uniform() - 80, 160 * random.uniform() - 80, 3 * random.uniform()},
                           k % 2 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}};
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) {
      const Vec3 to = lights[i].box.low - at.position;
      const double d = length(to), cosine = dot(to, at.normal) / d;
      if (cosine <= 0) continue;
      const double sent = cosine / (d * d);
      sum += sent, squares += sent * sent / tree.probability(at, i);
    }
    relative.push_back(squares / (sum * sum) - 1);
  }
  std::sort(relative.begin(), relative.end());
  std::printf("relative variance of a draw: median %.3f, upper tenth %.3f\n", relative[200], relative[360]);
  EXPECT_LT(relative[200], 0.1);
  EXPECT_LT(relative[360], 0.3);
}

TEST(LightTree, OneLampAndLampsAtOnePlace) {
  std::vector<LightBounds> same(500);
  for (LightBounds& b : same) b.box = {{1, 1, 1}, {1, 1, 1}}, b.cone = kPi, b.power = 1;
  const LightTree tree(same);
  EXPECT_NEAR(tree.probability({{0, 0, 0}, {0, 0, 1}}, 123), 1.0 / 500, 1e-3 / 500);
  const LightTree one(std::span<const LightBounds>(same).first(1));
  EXPECT_EQ(one.probability({{0, 0, 0}, {0, 0, 1}}, 0), 1);
  EXPECT_FALSE(one.sample({{0, 0, 0}, {0, 0, -1}}, 0.5));
}

}  // namespace
}  // namespace suite::light_tree_test
