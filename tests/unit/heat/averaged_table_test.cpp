#include "heat/averaged_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/message_of.h"

namespace suite::averaged_table_test {
namespace {

using Between = AveragedTable::Between;

TEST(AveragedTable, KeepsWhatIsLinearInAStep) {
  const AveragedTable t({0, 10, 30}, {5, 25, 5}, Between::linear, false);
  const StepLine a = t.over(2, 8), b = t.over(10, 30);
  EXPECT_NEAR(a.begin, 9, 1e-12);
  EXPECT_NEAR(a.end, 21, 1e-12);
  EXPECT_NEAR(b.begin, 25, 1e-12);
  EXPECT_NEAR(b.end, 5, 1e-12);
  EXPECT_NEAR(t.over(0, 30).mean(), 15, 1e-12);
}

// A jump in the middle of a step: the least-squares line of 0 | 1 is 1/2 + 3/2 (x - 1/2), held at 0 by turning it.
TEST(AveragedTable, LineOfAJump) {
  const AveragedTable jump({0, 1, 2}, {-1, 1, 1}, Between::held, false);
  EXPECT_NEAR(jump.over(0, 2).begin, -1.5, 1e-12);
  EXPECT_NEAR(jump.over(0, 2).end, 1.5, 1e-12);
  const AveragedTable light({0, 1, 2}, {0, 1, 1}, Between::held, false);
  EXPECT_EQ(light.over(0, 2).begin, 0);
  EXPECT_NEAR(light.over(0, 2).end, 1, 1e-12);
}

// Mean and first moment of random tables against the midpoint rule; steps short and long, over
// the end of a period and over several periods.
TEST(AveragedTable, MeanAndMomentOfAnyStep) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> times, values;
  for (int i = 0; i <= 500; ++i) times.push_back(1000 + i + 0.3 * uniform(random)), values.push_back(uniform(random));
  values.back() = values.front();
  const double period = times.back() - times.front();
  for (const Between between : {Between::linear, Between::held}) {
    const AveragedTable t(times, values, between, true);
    auto at = [&](double x) {
      x = times.front() + std::fmod(x - times.front() + 10 * period, period);
      size_t i = 0;
      while (i + 2 < times.size() && times[i + 1] <= x) ++i;
      if (between == Between::held) return values[i];
      return values[i] + (values[i + 1] - values[i]) * (x - times[i]) / (times[i + 1] - times[i]);
    };
    for (const auto& [begin, end] : {std::pair{1000.5, 1000.6}, {1003.2, 1250.9}, {1480.0, 1530.0}, {900.0, 2100.0}}) {
      double mean = 0, moment = 0;
      const int points = 40000;
      for (int i = 0; i < points; ++i) {
        const double f = (i + 0.5) / points, v = at(begin + f * (end - begin));
        mean += v / points;
        moment += v * (f - 0.5) / points;
      }
      const StepLine line = t.over(begin, end);
      EXPECT_NEAR(line.mean(), mean, 1e-3) << begin;
      EXPECT_NEAR(line.end - line.begin, 12 * moment, 4e-3) << begin;
    }
  }
}

// Sums over the whole table and piece by piece are one to rounding.
TEST(AveragedTable, SumsDoNotCancel) {
  std::vector<double> times, values;
  for (int i = 0; i <= 86400; ++i) times.push_back(i), values.push_back(300 + 0.001 * i);
  const AveragedTable t(times, values, Between::linear, false);
  for (const double width : {0.1, 60.0, 66.0, 600.0}) {
    const StepLine line = t.over(80000, 80000 + width);
    EXPECT_NEAR(line.begin, 380, 1e-5) << width;
    EXPECT_NEAR(line.end, 380 + 0.001 * width, 1e-5) << width;
  }
}

// Deviation about the line: of 0 | 6 | 0 | 6 ... it is 3, of a straight line 0, of noise on one the noise's.
TEST(AveragedTable, DeviationIsOfTheGusts) {
  std::vector<double> times, values, slope;
  for (int i = 0; i <= 3600; ++i) times.push_back(i), values.push_back(i % 2 * 6), slope.push_back(0.01 * i);
  EXPECT_NEAR(AveragedTable(times, values, Between::held, true).deviation(100, 700), 3, 1e-3);
  EXPECT_NEAR(AveragedTable(times, slope, Between::linear, false).deviation(100, 700), 0, 1e-5);
  for (size_t i = 0; i < values.size(); ++i) values[i] += slope[i];
  EXPECT_NEAR(AveragedTable(times, values, Between::held, false).deviation(100, 700), 3, 1e-3);
}

TEST(AveragedTable, AveragedKeepsTheMean) {
  std::vector<double> times, values;
  for (int i = 0; i <= 3600; ++i) times.push_back(i), values.push_back(i % 2);
  const AveragedTable calm = AveragedTable(times, values, Between::held, true).averaged(600);
  for (const double t : {0.0, 333.0, 1234.0, 3500.0}) {
    EXPECT_NEAR(calm.over(t, t + 50).begin, 0.5, 1e-9);
    EXPECT_NEAR(calm.over(t, t + 50).end, 0.5, 1e-9);
  }
}

TEST(AveragedTable, RefusesBadTables) {
  const auto make = [](std::vector<double> t, std::vector<double> v, bool repeat = false) {
    return message_of([&] { AveragedTable(t, v, Between::linear, repeat); });
  };
  EXPECT_NE(make({0}, {1}).find("1 times"), std::string::npos);
  EXPECT_NE(make({0, 1}, {1}).find("1 values"), std::string::npos);
  EXPECT_NE(make({0, 0}, {1, 1}).find("row 2"), std::string::npos);
  EXPECT_NE(make({0, 1}, {1, NAN}).find("not finite"), std::string::npos);
  EXPECT_NE(make({0, 1}, {1, 2}, true).find("repeats"), std::string::npos);
  const AveragedTable t({0, 1}, {1, 1}, Between::linear, false);
  EXPECT_NE(message_of([&] { t.over(0.5, 1.5); }).find("must cover the run"), std::string::npos);
}

}  // namespace
}  // namespace suite::averaged_table_test
