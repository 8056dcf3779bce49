// Histories in floats: what they keep to which digit.
#include "heat/histories.h"

#include <gtest/gtest.h>

#include <cmath>

#include "spectral/planck.h"

namespace suite::histories_test {
namespace {

double black(double kelvin) { return kStefanBoltzmann * std::pow(kelvin, 4); }
double kelvin_of(double emitted) { return std::sqrt(std::sqrt(emitted / kStefanBoltzmann)); }

TEST(Histories, KeepTemperatures) {
  const size_t moments = 145;
  Histories h(3, moments);
  std::vector<double> day(moments), moon(moments), same(moments, black(300.0 / 7));
  for (size_t m = 0; m < moments; ++m) {
    const double wave = std::sin(2 * 3.14159265358979 * static_cast<double>(m) / (moments - 1));
    day[m] = black(290 + 30 * wave), moon[m] = black(wave > 0 ? 95 + 300 * wave : 95 - wave);
  }
  h.set(0, day), h.set(1, moon), h.set(2, same);
  double worst[2] = {0, 0};
  for (size_t m = 0; m < moments; ++m) {
    worst[0] = std::fmax(worst[0], std::fabs(kelvin_of(h.at(0, m)) - kelvin_of(day[m])));
    worst[1] = std::fmax(worst[1], std::fabs(kelvin_of(h.at(1, m)) - kelvin_of(moon[m])));
    EXPECT_EQ(h.at(2, m), same[m]);
  }
  std::printf("day %.1e K, moon %.1e K\n", worst[0], worst[1]);
  EXPECT_LT(worst[0], 6e-6);
  EXPECT_LT(worst[1], 6e-6);
  // Negative control: differences from the mean would lose as much of the moon's night as is asked for.
  double mean = 0, night = 0;
  for (const double e : moon) mean += e / static_cast<double>(moments);
  for (const double e : moon)
    night = std::fmax(night, std::fabs(kelvin_of(mean + double{static_cast<float>(e - mean)}) - kelvin_of(e)));
  EXPECT_GT(night, 6e-6);
}

TEST(Histories, RowsAreTakenChangedAndDropped) {
  Histories all(3, 2), first(2, 2);
  const std::vector<double> a{1, 2}, b{5, 4}, c{7, 7};
  for (size_t row = 0; row < 3; ++row) all.set(row, c);
  first.set(0, a), first.set(1, b);
  all.take(first);
  EXPECT_EQ(all.at(0, 1), 2);
  EXPECT_EQ(all.at(1, 0), 5);
  EXPECT_EQ(all.at(2, 0), 7);
  all.change([](double v) { return 10 - v; });
  EXPECT_EQ(all.at(0, 1), 8);
  EXPECT_EQ(all.at(2, 1), 3);
  all.shrink(1);
  EXPECT_EQ(all.rows(), 1u);
  std::vector<double> row(2);
  all.get(0, row);
  EXPECT_EQ(row, (std::vector<double>{9, 8}));
}

}  // namespace
}  // namespace suite::histories_test
