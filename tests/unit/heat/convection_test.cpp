// Laws of convection against values worked out by hand from the published formulas, and what all rows promise.
#include "heat/convection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/message_of.h"

namespace suite::convection_test {
namespace {

using testing::HasSubstr;

double h(const ConvectionSpec& spec, const Airflow& air) { return make_convection(spec)->coefficient(air); }
Airflow warmer_by(double kelvin, double wind = 0, double cosine_up = 0, bool windward = true) {
  return {295 + kelvin, 295, wind, cosine_up, windward};
}

TEST(Convection, McAdams) {
  // 5.678 (0.99 + 0.21 * 3 / 0.3048), 5.678 (1.09 + 0.23 * 3 / 0.3048), 5.678 * 0.50 (10 / 0.3048)^0.78, with 0.53
  EXPECT_NEAR(h({"mcadams", {}, ""}, warmer_by(8, 3)), 17.357244, 1e-6);
  EXPECT_NEAR(h({"mcadams", {}, "rough"}, warmer_by(8, 3)), 19.042760, 1e-6);
  EXPECT_NEAR(h({"mcadams", {}, "smooth"}, warmer_by(8, 10)), 43.214921, 1e-6);
  EXPECT_NEAR(h({"mcadams", {}, "rough"}, warmer_by(8, 10)), 45.807816, 1e-6);
  // Its rounded form.
  for (const double v : {0.0, 2.0, 4.0}) EXPECT_NEAR(h({"mcadams", {}, ""}, warmer_by(0, v)), 5.7 + 3.8 * v, 0.5);
}

TEST(Convection, Tarp) {
  // Still air, 8 K (cube root 2): 1.31 * 2; 9.482 * 2 / (7.238 - 1); 1.81 * 2 / (1.382 + 1); the last two at 45 deg.
  const ConvectionSpec tarp{"tarp", {}, ""};
  EXPECT_NEAR(h(tarp, warmer_by(8)), 2.62, 1e-12);
  EXPECT_NEAR(h(tarp, warmer_by(8, 0, 1)), 3.040077, 1e-6);
  EXPECT_NEAR(h(tarp, warmer_by(-8, 0, -1)), 3.040077, 1e-6);
  EXPECT_NEAR(h(tarp, warmer_by(-8, 0, 1)), 1.519731, 1e-6);
  EXPECT_NEAR(h(tarp, warmer_by(8, 0, -1)), 1.519731, 1e-6);
  EXPECT_NEAR(h(tarp, warmer_by(8, 0, std::sqrt(0.5))), 2.903738, 1e-6);
  EXPECT_NEAR(h(tarp, warmer_by(-8, 0, std::sqrt(0.5))), 1.732798, 1e-6);
  // 2.537 * 1.67 sqrt(0.4 * 4), half in the lee.
  const ConvectionSpec rough{"tarp", {{"perimeter_per_area_1_m", 0.4}}, "rough"};
  EXPECT_NEAR(h(rough, warmer_by(0, 4)), 5.359163, 1e-6);
  EXPECT_NEAR(h(rough, warmer_by(8, 4, 0, false)), 2.62 + 5.359163 / 2, 1e-6);
}

TEST(Convection, Mowitt) {
  // sqrt((0.84 * 2)^2 + (3.26 * 5^0.89)^2), in the lee 3.55 * 5^0.617
  EXPECT_NEAR(h({"mowitt", {}, ""}, warmer_by(8, 5)), 13.758246, 1e-6);
  EXPECT_NEAR(h({"mowitt", {}, ""}, warmer_by(8, 5, 0, false)), 9.728959, 1e-6);
}

// F. P. Incropera and others, Fundamentals of heat and mass transfer, example 9.2: a screen 0.71 m high at 232 degC in
// air of 23 degC has Ra = 1.813e9, Nu = 147, h = 7.0 W/(m2 K) with tabulated air.
TEST(Convection, StillAirAtAFirescreen) {
  const Airflow air{232 + 273.15, 23 + 273.15, 0, 0};
  EXPECT_NEAR(h({"still_air", {{"length_m", 0.71}}, ""}, air), 7.0, 0.1);
  // A flat plate of Ra 1e7 is where both laws for rising air meet, 0.54 * 56.2 = 30.4 against 0.15 * 215 = 32.3.
  double last = 0;
  for (double dt = 0.01; dt < 100; dt *= 1.1) {
    const double now = h({"still_air", {{"length_m", 0.2}}, ""}, warmer_by(dt, 0, 1));
    EXPECT_GT(now, last * 0.999);
    last = now;
  }
}

// Every law: finite, not negative, the loss grows with the temperature difference, and nobody else's parameters.
TEST(Convection, EveryLaw) {
  EXPECT_EQ(convection_laws().size(), 5u);
  for (const ConvectionRow& row : convection_laws()) {
    EXPECT_EQ(row.unit, "W/(m2 K)");
    EXPECT_FALSE(row.valid.empty());
    ConvectionSpec spec{row.name, {}, ""};
    for (const Parameter& p : row.parameters)
      if (p.required) spec.numbers[p.name] = p.low;
    for (const double up : {-1.0, -0.5, 0.0, 0.5, 1.0})
      for (const double wind : {0.0, 0.1, 5.0, 30.0}) {
        double last = -INFINITY;
        for (double dt = -50; dt <= 50; dt += 0.5) {
          const double now = h(spec, warmer_by(dt, wind, up));
          ASSERT_TRUE(now >= 0 && std::isfinite(now)) << row.name;
          ASSERT_GE(now * dt, last - 1e-12) << row.name << " at " << dt << " K, tilt " << up;
          last = now * dt;
        }
      }
    spec.numbers["colour"] = 1;
    EXPECT_THAT(message_of([&] { make_convection(spec); }), HasSubstr("no parameter 'colour'"));
  }
  EXPECT_THAT(message_of([] { make_convection({"mcadam", {}, ""}); }), HasSubstr("did you mean 'mcadams'"));
  EXPECT_THAT(message_of([] { make_convection({"constant", {}, ""}); }), HasSubstr("needs 'still_w_m2_k'"));
  EXPECT_THAT(message_of([] { make_convection({"constant", {{"still_w_m2_k", -1}}, ""}); }), HasSubstr("outside"));
  EXPECT_THAT(message_of([] { make_convection({"tarp", {}, "hairy"}); }), HasSubstr("no roughness 'hairy'"));
  EXPECT_THAT(message_of([] { make_convection({"mowitt", {}, "rough"}); }), HasSubstr("takes no roughness"));
}

}  // namespace
}  // namespace suite::convection_test
