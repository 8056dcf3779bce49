#include "air/gases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <thread>

#include "air/gas_intervals.h"
#include "support/message_of.h"

namespace suite::gases_test {
namespace {

using testing::HasSubstr;

// Every band has the same absorbers, which the test gives.
struct Given final : GasProvider {
  std::vector<GasPoints> all;
  mutable std::atomic<int> asked = 0;
  double low_um() const override { return 1; }
  double high_um() const override { return 10; }
  std::string note() const override { return "given by a test"; }
  std::vector<Band> bands(double low_cm, double high_cm) const override { return {{low_cm, high_cm, 0}}; }
  std::vector<GasPoints> absorbers(const Band&, std::span<const AirLevel>) const override {
    ++asked;
    return all;
  }
};

std::vector<AirLevel> uniform(size_t count, double top) {
  std::vector<AirLevel> levels(count);
  for (size_t i = 0; i < count; ++i) levels[i].height = top * static_cast<double>(i) / static_cast<double>(count - 1);
  return levels;
}
// k (1/m) of points, times a factor at each level.
GasPoints points(std::vector<double> weight, const std::vector<double>& k, const std::vector<double>& factor) {
  GasPoints out;
  out.weight = std::move(weight);
  for (const double f : factor)
    for (const double x : k) out.absorption.push_back(static_cast<float>(x * f));
  return out;
}
double transmittance(const GasPoints& p, std::span<const AirLevel> levels, double path = 1) {
  const std::vector<double> depth = vertical_depths(p, levels);
  double sum = 0;
  for (size_t g = 0; g < depth.size(); ++g) sum += p.weight[g] * std::exp(-path * depth[g]);
  return sum;
}

TEST(GasPoints, UniformGasIsTheClosedForm) {
  Given given;
  given.all = {points({0.25, 0.75}, {0.002, 0.0001}, {1, 1, 1})};
  const auto levels = uniform(3, 1000);
  const GasPoints p = gas_points(given, levels, 2, 2.1);
  ASSERT_EQ(p.count(), 2u);
  for (const double path : {0.01, 1.0, 3.0})
    EXPECT_NEAR(transmittance(p, levels, path), 0.25 * std::exp(-2 * path) + 0.75 * std::exp(-0.1 * path), 1e-6);
}

// Two gases: at random together they let through the product, whether they lie in the same layers or one above the
// other.
TEST(GasPoints, RandomOverlapMultiplies) {
  const auto levels = uniform(5, 4000);
  const std::vector<double> low = {1, 1, 0.5, 0, 0}, high = {0, 0, 0.5, 1, 1};
  for (const auto& where : {low, high}) {
    Given given;
    const GasPoints a = points({0.5, 0.5}, {0.002, 0}, low), b = points({0.6, 0.4}, {0.001, 0.0001}, where);
    given.all = {a, b};
    const GasPoints both = gas_points(given, levels, 2, 2.1);
    EXPECT_NEAR(transmittance(both, levels), transmittance(a, levels) * transmittance(b, levels), 1e-3);
    EXPECT_EQ(both.count(), 4u);
  }
}

// A gas that hardly absorbs has one point, whose absorption is the mean.
TEST(GasPoints, WeakLimitIsTheMean) {
  Given given;
  given.all = {points({0.9, 0.1}, {1e-7, 1e-6}, {1, 1})};
  const auto levels = uniform(2, 1000);
  const GasPoints p = gas_points(given, levels, 2, 2.1);
  ASSERT_EQ(p.count(), 1u);
  EXPECT_NEAR(p.absorption[0] / 1.9e-7, 1, 1e-3);
}

// Many points of k over six decades: few points keep the transmittance of paths from a thirtieth to five columns; more
// points keep it better.
TEST(GasPoints, FewPointsKeepTheTransmittance) {
  Given given;
  std::vector<double> weight, k;
  for (int i = 0; i < 48; ++i) weight.push_back(1.0 / 48), k.push_back(std::pow(10.0, -7 + i / 8.0));
  given.all = {points(weight, k, {1, 0.3, 0.1})};
  const auto levels = uniform(3, 2000);
  double before = 1;
  for (const int most : {1, 2, 4, 8}) {
    GasReduction reduction;
    reduction.most = most;
    const GasPoints p = gas_points(given, levels, 2, 2.1, reduction);
    EXPECT_LE(p.count(), static_cast<size_t>(most));
    EXPECT_NEAR(std::accumulate(p.weight.begin(), p.weight.end(), 0.0), 1, 1e-12);
    double worst = 0;
    for (const double path : {0.03, 0.1, 0.3, 1.0, 2.0, 5.0})
      worst = std::max(worst, std::abs(transmittance(p, levels, path) - transmittance(given.all[0], levels, path)));
    EXPECT_LT(worst, before / 1.5) << most;
    before = worst;
  }
  EXPECT_LT(before, 0.006);
}

TEST(GasPoints, RefusesWhatIsNotThere) {
  const Given given;
  const auto levels = uniform(2, 1000);
  EXPECT_THAT(message_of([&] { gas_points(given, levels, 0.9, 2); }), HasSubstr("the table reaches from 1 to 10 um"));
  EXPECT_THAT(message_of([&] { gas_points(given, levels, 3, 2); }), HasSubstr("positive wavelengths"));
  GasReduction none;
  none.most = 0;
  EXPECT_THAT(message_of([&] { gas_points(given, levels, 2, 3, none); }), HasSubstr("1 to 16"));
}

// Whatever the interval and the air (dry, empty above, a cellar, hot): weights sum to 1, absorption is a number of 0 or
// more and points ascend in depth.
TEST(GasPoints, BuiltinHoldsEverywhere) {
  std::vector<std::vector<AirLevel>> airs(3);
  const AirProfile standard = standard_profile("tropical");
  for (const double h : {-400.0, 0.0, 10.0, 5000.0, 60000.0, 120000.0, 130000.0}) airs[0].push_back(standard.at(h));
  for (const double h : {0.0, 1000.0, 2000.0}) airs[1].push_back({h, 1e5 * std::exp(-h / 8000), 2000, {}});
  airs[2] = airs[1];
  for (AirLevel& level : airs[2]) level.share(Gas::h2o) = 0.3, level.share(Gas::co2) = 0.7;
  for (const auto& levels : airs)
    for (double low = 0.2; low < 900; low *= 1.37)
      for (const double width : {1e-6, 1e-3, 0.3}) {
        const double high = std::min(1000.0, low * (1 + width));
        const GasPoints p = gas_points(builtin_gases(), levels, low, high);
        ASSERT_EQ(p.absorption.size(), p.count() * levels.size());
        EXPECT_NEAR(std::accumulate(p.weight.begin(), p.weight.end(), 0.0), 1, 1e-9);
        for (const float k : p.absorption) ASSERT_TRUE(k >= 0 && k < 1e30f) << low << " " << width;
        const std::vector<double> depth = vertical_depths(p, levels);
        EXPECT_TRUE(std::is_sorted(depth.begin(), depth.end())) << low << " " << width;
      }
}

TEST(GasPoints, BuiltinCoversItsRangeWithoutGaps) {
  const GasProvider& gases = builtin_gases();
  const auto bands = gases.bands(1e4 / gases.high_um(), 1e4 / gases.low_um());
  ASSERT_GT(bands.size(), 9000u);
  EXPECT_DOUBLE_EQ(bands.front().low_cm, 1e4 / gases.high_um());
  EXPECT_DOUBLE_EQ(bands.back().high_cm, 1e4 / gases.low_um());
  for (size_t i = 1; i < bands.size(); ++i) ASSERT_DOUBLE_EQ(bands[i].low_cm, bands[i - 1].high_cm);
}

// The builtin continuum of water in the form that goes with lines is the builtin one.
TEST(Gases, BuiltinContinuumInTheOtherForm) {
  const auto other = builtin_gases(builtin_continuum());
  std::vector<AirLevel> levels(3);
  levels[0] = {0, 1e5, 296, {}}, levels[1] = {1000, 9e4, 278, {}}, levels[2] = {2000, 8e4, 260, {}};
  for (AirLevel& l : levels) l.share(Gas::h2o) = 0.02;
  for (const double v : {600.0, 900.0, 1050.0, 1600.0, 2500.0, 8000.0}) {
    const GasProvider::Band band = builtin_gases().bands(v, v + 1).front();
    const std::vector<float> own = builtin_gases().absorbers(band, levels)[0].absorption,
                             same = other->absorbers(band, levels)[0].absorption;
    // The radiation field of the foreign part is that of 296 K in the builtin one: next to nothing at 900 cm-1, 4 % at
    // 600 and 260 K.
    const double field = radiation_field(v, 260) / radiation_field(v, 296) - 1;
    EXPECT_NEAR(same[0] / own[0], 1, 1e-4) << v;
    EXPECT_NEAR(same[1] / own[1], 1, 1e-3 + field) << v;
    EXPECT_NEAR(same[2] / own[2], 1, 1e-3 + 1.01 * field) << v;
  }
}

TEST(GasIntervals, are_the_points_of_the_interval_computed_once) {
  const auto given = std::make_shared<Given>();
  const std::vector<AirLevel> levels = uniform(3, 1e4);
  given->all = {points({0.5, 0.5}, {1e-5, 1e-3}, {1, 0.5, 0.25})};
  GasIntervals intervals(given, levels, {}, 2);
  const GasPoints straight = gas_points(*given, levels, 2, 3);
  given->asked = 0;
  for (int times = 0; times < 3; ++times) {
    const auto found = intervals.points(2, 3);
    EXPECT_EQ(found->weight, straight.weight);
    EXPECT_EQ(found->absorption, straight.absorption);
  }
  EXPECT_EQ(given->asked, 1);
  // Beyond those that are kept it computes each time.
  intervals.points(3, 4), intervals.points(4, 5), intervals.points(4, 5);
  EXPECT_EQ(given->asked, 4);
  EXPECT_EQ(intervals.kept(), 2u);
}

TEST(GasIntervals, are_the_same_for_many_threads) {
  const std::vector<AirLevel> levels = uniform(3, 1e4);
  const auto given = std::make_shared<Given>();
  given->all = {points({0.5, 0.5}, {1e-5, 1e-3}, {1, 0.5, 0.25})};
  GasIntervals intervals(given, levels, {}, 40);
  std::array<size_t, 4> same{};
  std::vector<std::thread> threads;
  const GasPoints wanted = gas_points(*given, levels, 2, 3);
  for (size_t t = 0; t < same.size(); ++t)
    threads.emplace_back([&, t] {
      for (int n = 0; n < 400; ++n) {
        const double low = 2 + 0.1 * ((n + 13 * static_cast<int>(t)) % 50);
        same[t] += intervals.points(low, low + 1)->absorption == wanted.absorption;
      }
    });
  for (std::thread& t : threads) t.join();
  for (const size_t n : same) EXPECT_EQ(n, 400u);
  EXPECT_EQ(intervals.kept(), 40u);
}

TEST(GasIntervals, are_shared_by_the_same_air_alone) {
  const auto given = std::make_shared<Given>(), other = std::make_shared<Given>();
  std::vector<AirLevel> levels = uniform(3, 1e4);
  const auto shared = shared_gas_intervals(given, levels, {});
  EXPECT_EQ(shared_gas_intervals(given, levels, {}), shared);
  EXPECT_NE(shared_gas_intervals(other, levels, {}), shared);
  EXPECT_NE(shared_gas_intervals(given, levels, {.most = 2}), shared);
  EXPECT_NE(shared_gas_intervals(given, levels, {.thin = 0.03}), shared);
  EXPECT_NE(shared_gas_intervals(given, levels, {.error = 0.003}), shared);
  const std::vector<AirLevel> as_given = levels;
  const auto differs = [&] {
    const bool other_air = !shared_gas_intervals(given, as_given, {})->are_of(given.get(), levels, {});
    levels = as_given;
    return other_air;
  };
  levels[1].height += 1;
  EXPECT_TRUE(differs());
  levels[1].pressure += 1;
  EXPECT_TRUE(differs());
  levels[1].temperature += 1;
  EXPECT_TRUE(differs());
  levels[1].fraction.back() += 1e-9;
  EXPECT_TRUE(differs());
  EXPECT_FALSE(differs());
}

}  // namespace
}  // namespace suite::gases_test
