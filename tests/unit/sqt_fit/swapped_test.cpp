// Exchanged directions: what was a function of the light becomes one of the view.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "sqt_fit/swapped.h"

namespace suite::sqt::swapped_test {
namespace {

struct Lopsided : Function {
  Info i;
  const Info& info() const override { return i; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    for (double& v : f) v = 10 * out.z + in.z;
  }
};

TEST(SqtSwapped, LightAndViewChangePlaces) {
  const auto lopsided = std::make_shared<Lopsided>();
  lopsided->i.source = "table";
  const auto turned = swapped(lopsided);
  EXPECT_EQ(turned->info().source, "table, directions exchanged");
  std::array<double, 2> f{};
  turned->value({0.6, 0, 0.8}, {0, 0, 1}, f);
  EXPECT_DOUBLE_EQ(f[0], 10 * 1 + 0.8);
  EXPECT_DOUBLE_EQ(f[1], f[0]);
  swapped(turned)->value({0.6, 0, 0.8}, {0, 0, 1}, f);
  EXPECT_DOUBLE_EQ(f[0], 10 * 0.8 + 1);
  turned->value({0.6, 0, 0.8}, {0, 0, -1}, f);  // no data below the horizon
  EXPECT_TRUE(std::isnan(f[0]));
}

TEST(SqtSwapped, OnlyReflectanceHasTwoDirectionsToExchange) {
  const auto phase = std::make_shared<Lopsided>(), both_sides = std::make_shared<Lopsided>();
  phase->i.quantity = Quantity::phase;
  both_sides->i.domain = Domain::sphere;
  EXPECT_THROW(swapped(phase), Error);
  EXPECT_THROW(swapped(both_sides), Error);
}

}  // namespace
}  // namespace suite::sqt::swapped_test
