// Interpolation of weather: monotone through instants, the means of intervals kept, integrals exact.
#include "heat/weather_series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "math/sampling.h"

namespace suite::weather_series_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Gauss-Legendre with three points: exact for the cubics of each piece, of which `pieces` divide begin..end.
double quadrature(const std::function<double(double)>& f, double begin, double end, int pieces) {
  const double h = (end - begin) / pieces, x = std::sqrt(0.6);
  double sum = 0;
  for (int i = 0; i < pieces; ++i) {
    const double middle = begin + h * (i + 0.5);
    sum += h / 18 * (5 * f(middle - x * h / 2) + 8 * f(middle) + 5 * f(middle + x * h / 2));
  }
  return sum;
}

struct Rows {
  std::vector<double> times, values;
};
Rows jumpy_rows(uint64_t seed, size_t n) {
  Pcg32 random(seed);
  Rows rows;
  double t = 0;
  for (size_t i = 0; i < n; ++i) {
    rows.times.push_back(t);
    const double u = random.uniform();
    rows.values.push_back(u < 0.3 ? 0 : u < 0.6 ? 1 : 100 * random.uniform());
    t += 10 + 100 * random.uniform();
  }
  return rows;
}

TEST(WeatherSeries, InstantsAreMetAndNothingOvershoots) {
  const Rows rows = jumpy_rows(5, 400);
  const WeatherSeries s = WeatherSeries::of_instants(rows.times, rows.values, 1000);
  for (size_t i = 0; i + 1 < rows.times.size(); ++i) {
    EXPECT_NEAR(s.at(rows.times[i]), rows.values[i], 1e-12);
    const auto [low, high] = std::minmax(rows.values[i], rows.values[i + 1]);
    for (int k = 0; k <= 40; ++k) {
      const double v = s.at(rows.times[i] + (rows.times[i + 1] - rows.times[i]) * k / 40);
      ASSERT_GE(v, low - 1e-10) << i;
      ASSERT_LE(v, high + 1e-10) << i;
    }
  }
}

// Central slopes without a limit dip below 0 before the rise: what the check above refuses.
TEST(WeatherSeries, WithoutLimitsItWouldOvershoot) {
  const double x[] = {0, 1, 2, 3}, y[] = {0, 0, 1, 1}, s = 2.0 / 3;
  const double central = 0.5;  // at x = 1
  EXPECT_LT(-central * s * s * (1 - s), -0.07);
  EXPECT_EQ(WeatherSeries::of_instants(x, y, 10).at(s), 0);
}

TEST(WeatherSeries, SmoothInstantsAreMetToThirdOrder) {
  double errors[2];
  for (int level = 0; level < 2; ++level) {
    const int n = level ? 48 : 24;
    Rows rows;
    for (int i = 0; i <= n; ++i) {
      rows.times.push_back(24.0 * i / n);
      rows.values.push_back(std::exp(rows.times.back() / 12));  // monotone: nothing is limited
    }
    const WeatherSeries s = WeatherSeries::of_instants(rows.times, rows.values, 10);
    errors[level] = 0;
    for (double t = 6; t < 18; t += 0.01) errors[level] = std::max(errors[level], std::abs(s.at(t) - std::exp(t / 12)));
  }
  EXPECT_LT(errors[1], 1e-5);
  EXPECT_GT(errors[0] / errors[1], 7);
}

TEST(WeatherSeries, MeansAreKeptAndStayAboveZero) {
  const Rows rows = jumpy_rows(6, 400);
  const size_t n = rows.times.size() - 1;
  const std::vector<double> begins(rows.times.begin(), rows.times.end() - 1),
      ends(rows.times.begin() + 1, rows.times.end());
  const std::vector<double> means(rows.values.begin(), rows.values.end() - 1);
  const WeatherSeries s = WeatherSeries::of_means(begins, ends, means);
  double before = 0;
  for (size_t i = 0; i < n; ++i) {
    EXPECT_NEAR(s.mean(begins[i], ends[i]), means[i], 1e-10);
    EXPECT_NEAR(
        quadrature([&](double t) { return s.at(t); }, begins[i] + 1e-9, ends[i] - 1e-9, 1) / (ends[i] - begins[i]),
        means[i], 1e-6);
    for (int k = 0; k <= 40; ++k) ASSERT_GE(s.at(begins[i] + (ends[i] - begins[i]) * k / 40), -1e-12) << i;
    // No steps from one interval to the next.
    if (i > 0) {
      EXPECT_NEAR(s.at(begins[i] + 1e-7), before, 1e-4) << i;
    }
    before = s.at(ends[i] - 1e-7);
  }
}

TEST(WeatherSeries, ASteadyMeanIsSteady) {
  const double begins[] = {0, 1, 2}, ends[] = {1, 2, 3}, means[] = {7, 7, 7};
  const WeatherSeries s = WeatherSeries::of_means(begins, ends, means);
  for (double t = 0; t <= 3; t += 0.1) EXPECT_NEAR(s.at(t), 7, 1e-14);
}

TEST(WeatherSeries, MeansOverAnyIntervalAreThoseOfTheCurve) {
  const Rows rows = jumpy_rows(7, 100);
  const WeatherSeries s = WeatherSeries::of_instants(rows.times, rows.values, 1000);
  Pcg32 random(8);
  for (int k = 0; k < 200; ++k) {
    const double end = rows.times.back() * random.uniform(), begin = end * random.uniform();
    const double expected = quadrature([&](double t) { return s.at(t); }, begin, end, 4000) / (end - begin);
    EXPECT_NEAR(s.mean(begin, end), expected, 2e-3);
  }
  // Additive to rounding.
  const double a = 123.4, b = 1789.1, c = 3456.7;
  EXPECT_NEAR(s.mean(a, c) * (c - a), s.mean(a, b) * (b - a) + s.mean(b, c) * (c - b), 1e-8);
  EXPECT_EQ(s.mean(a, a), s.at(a));
  EXPECT_THROW(s.mean(b, a), Error);
}

TEST(WeatherSeries, WhatIsMissingStaysMissing) {
  const double times[] = {0, 1, 2, 3, 4, 9, 10}, values[] = {1, 2, kNaN, 4, 5, 6, 7};
  const WeatherSeries s = WeatherSeries::of_instants(times, values, 1.5);
  EXPECT_EQ(s.at(0.5), 1.5);
  for (const double t : {-0.1, 1.5, 2.0, 2.5, 4.5, 8.9, 10.1}) EXPECT_TRUE(std::isnan(s.at(t))) << t;
  EXPECT_FALSE(std::isnan(s.at(9.5)));
  EXPECT_TRUE(std::isnan(s.mean(0.5, 3.5)));
  EXPECT_TRUE(std::isnan(s.mean(3.5, 9.5)));
  EXPECT_TRUE(std::isnan(s.mean(-1, 0.5)));
  EXPECT_NEAR(s.mean(3, 4), 4.5, 1e-15);
  const double begins[] = {0, 1, 2, 5}, ends[] = {1, 2, 3, 6}, means[] = {1, kNaN, 3, 4};
  const WeatherSeries m = WeatherSeries::of_means(begins, ends, means);
  EXPECT_TRUE(std::isnan(m.at(1.5)) && std::isnan(m.at(4)) && std::isnan(m.mean(2.5, 5.5)));
  EXPECT_EQ(m.at(2.5), 3);
  EXPECT_TRUE(WeatherSeries().empty());
  const double none[] = {kNaN, kNaN, kNaN, kNaN};
  EXPECT_TRUE(WeatherSeries::of_means(begins, ends, none).empty());
  EXPECT_TRUE(std::isnan(WeatherSeries::of_means(begins, ends, none).at(0.5)));
}

}  // namespace
}  // namespace suite::weather_series_test
