// When points are lit, told from others; integrals over what is lit.
#include "heat/passing_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "heat/lit_time.h"

namespace suite::passing_edges_test {
namespace {

// Lit from when an edge comes by until another one does; seen through a wide sun.
std::vector<PointDay> days(size_t count, double bend, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<PointDay> out;
  for (size_t k = 0; k < count; ++k) {
    PointDay d;
    for (double& x : d.place) x = any(random);
    d.changes = {1000 + 200 * d.place[0] - 50 * d.place[1] + 10 * d.place[3] + bend * d.place[0] * d.place[0],
                 5000 + 300 * d.place[1]};
    out.push_back(d);
  }
  return out;
}
std::vector<const PointDay*> pointers(const std::vector<PointDay>& all) {
  std::vector<const PointDay*> out;
  for (const PointDay& d : all) out.push_back(&d);
  return out;
}

TEST(PassingEdges, StraightOnesAreTold) {
  std::vector<PointDay> known = days(14, 0, 1);
  // Two that saw something else do not count.
  known.push_back({{0, 0, 0, 0}, false, {300}});
  known.push_back({{0, 0, 0, 0}, true, {}});
  const PassingEdges edges(pointers(known), true, 1);
  ASSERT_TRUE(edges.moves());
  for (const PointDay& d : days(50, 0, 2)) {
    const PointDay told = edges.at(d.place, 0, 86400);
    EXPECT_FALSE(told.lit_first);
    ASSERT_EQ(told.changes.size(), 2u);
    EXPECT_NEAR(told.changes[0], d.changes[0], 1e-3);
    EXPECT_NEAR(told.changes[1], d.changes[1], 1e-3);
  }
  // The same asked at a time, also where changes would be out of their order.
  for (const std::array<double, 4>& place :
       {std::array<double, 4>{0.3, -0.2, 0, 0.5}, {30, -20, 0, 0}, {-9, 9, 0, 0}}) {
    const PointDay day = edges.at(place, 0, 86400);
    for (double t = 5; t < 86400; t += 50)
      EXPECT_EQ(edges.lit_at(place, t), (t >= day.changes[0]) != (t >= day.changes[1])) << t;
  }
  // In order and within the day wherever it is asked.
  const PointDay far = edges.at({100, -100, 0, 0}, 0, 20000);
  EXPECT_LE(0, far.changes[0]);
  EXPECT_LE(far.changes[0], far.changes[1]);
  EXPECT_LE(far.changes[1], 20000);
}

TEST(PassingEdges, NothingIsToldOfWhatDoesNotPass) {
  std::vector<PointDay> still = days(14, 0, 3);
  for (PointDay& d : still) d.changes = {1000 + 0.3 * d.place[0], 5000};
  EXPECT_FALSE(PassingEdges(pointers(still), true, 1).moves()) << "within a second";
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> any(0, 400);
  for (PointDay& d : still) d.changes = {1000 + any(random), 5000};
  EXPECT_FALSE(PassingEdges(pointers(still), true, 1).moves()) << "as leaves do";
  EXPECT_FALSE(PassingEdges({}, true, 1).moves());
  EXPECT_FALSE(PassingEdges(pointers(days(4, 0, 5)), true, 1).moves()) << "of too few";
}

// Against sums over many instants.
TEST(LitTime, IntegralsAreExact) {
  constexpr double kBegin = 100, kStep = 60;
  constexpr size_t kSteps = 5;
  const std::vector<float> takes{1, 3, 2, 0, 4, 5};
  const std::vector<PointDay> all{{{}, true, {130, 250}}, {{}, false, {110, 112, 160, 395}}, {{}, true, {}}};
  LitTime lit(kBegin, kStep, kSteps);
  std::vector<double> found(kSteps + 1, 0), expected(kSteps + 1, 0);
  double total = 0;
  const std::vector<double> weights{1, -2, 0.5};
  for (size_t d = 0; d < all.size(); ++d) {
    lit.add(all[d], weights[d]);
    constexpr int kInstants = 600000;
    for (int i = 0; i < kInstants; ++i) {
      const double x = (i + 0.5) / kInstants * kSteps, t = kBegin + x * kStep;
      bool is_lit = all[d].lit_first;
      for (const double c : all[d].changes) is_lit ^= t > c;
      if (!is_lit) continue;
      const auto m = static_cast<size_t>(x);
      const double s = x - static_cast<double>(m), value = takes[m] + (takes[m + 1] - takes[m]) * s;
      const double weight = weights[d] * kSteps / kInstants;
      total += weight, expected[m] += weight * value * (1 - s), expected[m + 1] += weight * value * s;
    }
  }
  lit.spread(takes, {}, [&](size_t m, double v) { found[m] += v; });
  for (size_t m = 0; m <= kSteps; ++m) EXPECT_NEAR(found[m], expected[m], 2e-5) << m;
  EXPECT_NEAR(lit.total(), total, 2e-5);
  // By step, and a part of some steps.
  std::vector<float> by_step(kSteps), shares{1, 0.5f, 0, 1, 0.25f};
  lit.by_step(by_step);
  double sum = 0, of_shares = 0, spread = 0;
  for (size_t m = 0; m < kSteps; ++m) sum += double{by_step[m]}, of_shares += double{shares[m] * by_step[m]};
  EXPECT_NEAR(sum, total, 2e-5);
  EXPECT_NEAR(lit.total(shares), of_shares, 1e-5);
  const std::vector<float> ones(kSteps + 1, 1.0f);
  lit.spread(ones, shares, [&](size_t, double v) { spread += v; });
  EXPECT_NEAR(spread, of_shares, 1e-5);
  lit.clear();
  EXPECT_EQ(lit.total(), 0);
}

}  // namespace
}  // namespace suite::passing_edges_test
