// The balance of a face and elements without heat capacity.
#include "heat/balance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "heat/slab_batch.h"
#include "support/heat_kit.h"
#include "support/message_of.h"

namespace suite::balance_test {
namespace {

using namespace test;
using testing::HasSubstr;

std::shared_ptr<const ConvectionLaw> law(const ConvectionSpec& spec) { return make_convection(spec); }

TEST(Massless, MirrorLikeSheetWithoutAir) {
  // 459.3 W/m2 are what a black body of 300 K emits; absorptance and emissivity cancel.
  MasslessFace sheet;
  sheet.traits.emissivity = 0.02;
  sheet.weather.absorbed = 0.02 * 459.3003;
  sheet.weather.air_kelvin = 280;
  EXPECT_NEAR(massless_kelvin({&sheet, 1}), 300, 1e-4);
  // Both faces radiate: half each.
  MasslessFace back = sheet;
  back.weather.absorbed = 0;
  const std::vector<MasslessFace> both{sheet, back};
  EXPECT_NEAR(massless_kelvin(both), 300 / std::pow(2.0, 0.25), 1e-4);
}

TEST(Massless, LinearExchangeInClosedForm) {
  MasslessFace leaf;
  leaf.traits = {0, law({"constant", {{"still_w_m2_k", 10}}, ""}), 1, 0};
  leaf.weather.absorbed = 120;
  leaf.weather.source = 30;
  leaf.weather.air_kelvin = 290;
  EXPECT_NEAR(massless_kelvin({&leaf, 1}), 305, 1e-8);
}

// The root is one for all laws, winds and loads over wide ranges, and it is a root.
TEST(Massless, EveryLawFindsItsRoot) {
  int cases = 0;
  for (const char* name : {"mcadams", "tarp", "mowitt", "still_air"})
    for (const double wind : {0.0, 0.3, 8.0})
      for (const double emissivity : {0.0, 0.02, 0.97})
        for (const double absorbed : {0.0, 1.0, 1000.0, 1e6})
          for (const double wetness : {0.0, 1.0}) {
            MasslessFace face;
            face.traits = {emissivity, law({name, {}, ""}), 0.3, wetness};
            face.weather = {absorbed, 300, 285, wind, 0, true, 900};
            // Without emission nothing acts in still air, and a megawatt ends beyond 10000 K.
            if (emissivity == 0 && ((wind == 0 && absorbed == 0) || absorbed > 1e5)) continue;
            const double T = massless_kelvin({&face, 1});
            EXPECT_GE(net_flux(face.traits, face.weather, T - 1e-6), 0);
            EXPECT_LE(net_flux(face.traits, face.weather, T + 1e-6), 0);
            ++cases;
          }
  EXPECT_EQ(cases, 256);
}

TEST(Massless, RefusesWhatHasNoTemperature) {
  MasslessFace f;
  f.traits.emissivity = 0;
  EXPECT_THAT(message_of([&] { massless_kelvin({&f, 1}); }), HasSubstr("nothing acts on it"));
  f.weather.absorbed = 1;
  EXPECT_THAT(message_of([&] { massless_kelvin({&f, 1}); }), HasSubstr("do not meet"));
  f.weather.absorbed = NAN;
  EXPECT_THAT(message_of([&] { massless_kelvin({&f, 1}); }), HasSubstr("not finite"));
}

// Free water in unsaturated air without radiation is a wet bulb. At 30 degC, 30 % humidity and sea level the wet bulb
// is 18.0 degC (psychrometric chart, ASHRAE Handbook of Fundamentals).
TEST(Evaporation, WetBulb) {
  MasslessFace f;
  f.traits = {0, law({"constant", {{"still_w_m2_k", 20}}, ""}), 1, 1};
  f.weather.air_kelvin = 303.15;
  f.weather.vapour_pressure = 0.3 * saturation_pressure(303.15);
  EXPECT_NEAR(massless_kelvin({&f, 1}), 291.15, 0.3);
  // Saturated air does not cool, drier surfaces do so less.
  f.weather.vapour_pressure = saturation_pressure(303.15);
  EXPECT_NEAR(massless_kelvin({&f, 1}), 303.15, 1e-6);
  f.weather.vapour_pressure = 0.3 * saturation_pressure(303.15);
  f.traits.wetness = 0.2;
  EXPECT_GT(massless_kelvin({&f, 1}), 295);
  // Water boils at 100 degC and freezes at 611 Pa.
  EXPECT_NEAR(saturation_pressure(273.15), 611.2, 0.01);
  EXPECT_NEAR(saturation_pressure(293.15), 2339, 3);
}

// The line about a temperature is the balance there, and its error grows with the square of the distance.
TEST(Balance, LineOfTheLoss) {
  const FaceTraits face{0.9, law({"tarp", {}, ""}), 1, 0.5};
  const FaceWeather weather{400, 350, 290, 2, 0, true, 1000};
  for (const double T : {280.0, 290.0, 320.0}) {
    const FaceBalance b = balance_at(face, weather, T);
    EXPECT_NEAR(b.flux(T), net_flux(face, weather, T), 1e-9);
    EXPECT_GE(b.linear, 0);
    if (T == 290) continue;  // the law of still air bends without end where surface and air are equal
    const double one = std::fabs(b.flux(T + 1) - net_flux(face, weather, T + 1)),
                 two = std::fabs(b.flux(T + 2) - net_flux(face, weather, T + 2));
    EXPECT_LT(one, 1);
    EXPECT_LT(two, 5 * one);
  }
  // A law that does not depend on the surface: exact everywhere.
  const FaceTraits plain{0.9, law({"mcadams", {}, ""}), 1, 0};
  const FaceBalance b = balance_at(plain, weather, 290);
  for (const double T : {250.0, 300.0, 350.0}) EXPECT_NEAR(b.flux(T), net_flux(plain, weather, T), 1e-8);
}

// Wind evenly spread over 0 to 6 m/s: what its mean and deviation tell against the mean over all winds, within 2 %; the
// mean alone is up to 6 % off.
TEST(Balance, GustsBendTheLaws) {
  for (const char* name : {"tarp", "mowitt", "mcadams"}) {
    const FaceTraits face{0, law({name, {}, ""}), 0.4, 0};
    FaceWeather weather;
    weather.air_kelvin = 290;
    double mean = 0;
    for (int i = 0; i < 600; ++i) {
      weather.wind = 0.01 * (i + 0.5);
      mean += loss_to_air(face, weather, 300) / 600;
    }
    weather.wind = 3;
    const double alone = loss_to_air(face, weather, 300);
    weather.gusts = 6 / std::sqrt(12.0);
    std::printf("%s: %.4f of the mean, without gusts %.4f\n", name, loss_to_air(face, weather, 300) / mean,
                alone / mean);
    EXPECT_NEAR(loss_to_air(face, weather, 300), mean, 0.02 * mean);
    if (std::string(name) == "tarp") {
      EXPECT_GT(alone, 1.025 * mean);
    }
  }
}

// Backs of a slab in their steady states.
TEST(Balance, BackConditions) {
  SlabLayer wall;
  wall.thickness = 0.2;
  wall.density = 1000, wall.specific_heat = {1000}, wall.conductivity = {0.5};
  SlabBatch batch({wall}, 4);
  batch.start(0, 290);
  using Kind = BackCondition::Kind;
  const FaceBalance front{10 * 300, 10, 0};  // air of 300 K
  const auto loads = steady({{front, back_balance({Kind::flux, 5, 0})},
                             {front, back_balance({Kind::air, 280, 8})},
                             {front, back_balance({Kind::held, 285, 0})},
                             {front, back_balance({})}});
  for (int i = 0; i < 60; ++i) batch.step(1e5, loads);
  EXPECT_NEAR(batch.top(0), 300 + 5.0 / 10, 1e-6);
  EXPECT_NEAR(batch.bottom(0), 300.5 + 5 * 0.2 / 0.5, 1e-6);
  const double q = 20 / (0.1 + 0.4 + 0.125);
  EXPECT_NEAR(batch.top(1), 300 - q / 10, 1e-6);
  EXPECT_NEAR(batch.bottom(1), 280 + q / 8, 1e-6);
  EXPECT_NEAR(batch.bottom(2), 285, 1e-6);
  EXPECT_NEAR(batch.top(2), 300 - 15 / 0.5 / 10, 1e-5);
  EXPECT_NEAR(batch.bottom(3), 300, 1e-6);
  EXPECT_THAT(message_of([] { back_balance({Kind::air, 290, 0}); }), HasSubstr("film"));
  EXPECT_THAT(message_of([] { back_balance({Kind::held, -3, 0}); }), HasSubstr("-3 K"));
}

}  // namespace
}  // namespace suite::balance_test
