#include "air/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/message_of.h"

namespace suite::profile_test {
namespace {

using testing::HasSubstr;

// Columns integrated exponentially between the levels of AFGL-TR-86-0110 as libRadtran tabulates them in number
// densities (data/atmmod/afgl*.dat): numpy 2.4.6, sum of dz (b - a) / ln(b / a); and single levels of the same tables.
TEST(Profile, StandardsHaveTheColumnsOfTheReport) {
  const struct {
    const char* name;
    double water, ozone, co2;
  } expected[] = {{"tropical", 41.177, 281.99, 7.1415e25},          {"midlatitude_summer", 29.245, 334.37, 7.1242e25},
                  {"midlatitude_winter", 8.523, 378.22, 7.1446e25}, {"subarctic_summer", 20.827, 347.72, 7.0855e25},
                  {"subarctic_winter", 4.165, 375.45, 7.1033e25},   {"us_standard", 14.172, 344.21, 7.1077e25}};
  EXPECT_EQ(standard_profiles().size(), std::size(expected));
  for (const auto& e : expected) {
    const AirProfile p = standard_profile(e.name);
    EXPECT_NO_THROW(check_profile(p));
    EXPECT_NEAR(precipitable_water(p) / e.water, 1, 0.001) << e.name;
    EXPECT_NEAR(dobson(p) / e.ozone, 1, 0.001) << e.name;
    EXPECT_NEAR(column(p, Gas::co2) / e.co2, 1, 0.001) << e.name;
  }
  const AirLevel l = standard_profile("us_standard").at(10000);
  EXPECT_NEAR(l.pressure, 26500, 1);
  EXPECT_NEAR(l.temperature, 223.3, 1e-6);
  EXPECT_NEAR(l.density() / 8.595457e24, 1, 1e-3);
  EXPECT_NEAR(l.share(Gas::h2o) * l.density() / 6.017959e20, 1, 2e-3);
  EXPECT_NEAR(l.share(Gas::o3) * l.density() / 1.129443e18, 1, 2e-3);
  EXPECT_THAT(message_of([] { standard_profile("midlatitude_sumer"); }),
              HasSubstr("did you mean 'midlatitude_summer'"));
}

TEST(Profile, RunsLinearlyAndExponentiallyBetweenLevels) {
  AirProfile p;
  p.levels.resize(2);
  p.levels[0] = {1000, 90000, 280, {}};
  p.levels[1] = {3000, 70000, 260, {}};
  p.levels[0].share(Gas::h2o) = 0.01, p.levels[1].share(Gas::h2o) = 0.0025;
  p.levels[0].share(Gas::so2) = 1e-9;
  const AirLevel m = p.at(2000);
  EXPECT_DOUBLE_EQ(m.temperature, 270);
  EXPECT_NEAR(m.pressure, std::sqrt(90000.0 * 70000.0), 1e-6);
  EXPECT_NEAR(m.share(Gas::h2o), 0.005, 1e-12);
  EXPECT_NEAR(m.share(Gas::so2), 5e-10, 1e-20);
  EXPECT_EQ(p.at(0).pressure, 90000);
  EXPECT_EQ(p.at(4000).density(), 0);
}

// In isothermal air of one scale height H a constant share f has the column f n0 H (1 - exp(-z/H)).
TEST(Profile, ColumnOfIsothermalAir) {
  AirProfile p;
  for (int i = 0; i <= 10; ++i) {
    AirLevel l{1000.0 * i, 100000 * std::exp(-i / 8.0), 250, {}};
    l.share(Gas::ch4) = 1.7e-6;
    p.levels.push_back(l);
  }
  const double n0 = p.levels[0].density();
  EXPECT_NEAR(column(p, Gas::ch4) / (1.7e-6 * n0 * 8000 * (1 - std::exp(-1.25))), 1, 1e-9);
}

TEST(Profile, ScalesToWhatIsAskedFor) {
  ProfileScaling s;
  s.water = 25;
  s.ozone = 300;
  s.surface_pressure = 95000;
  s.at_ground[static_cast<size_t>(Gas::co2)] = 420e-6;
  const AirProfile p = scaled(standard_profile("us_standard"), s);
  EXPECT_NEAR(precipitable_water(p), 25, 1e-9);
  EXPECT_NEAR(dobson(p), 300, 1e-9);
  EXPECT_NEAR(p.levels[0].pressure, 95000, 1e-6);
  EXPECT_NEAR(p.at(80000).pressure / standard_profile("us_standard").at(80000).pressure, 1, 1e-5);
  EXPECT_NEAR(p.at(5000).share(Gas::co2), 420e-6, 1e-12);
  EXPECT_EQ(p.at(5000).share(Gas::ch4), standard_profile("us_standard").at(5000).share(Gas::ch4));
}

TEST(Profile, RefusesWhatIsNone) {
  const AirProfile good = standard_profile("tropical");
  const auto with = [&](auto change) {
    AirProfile p = good;
    change(p);
    return message_of([&] { check_profile(p); });
  };
  EXPECT_EQ(with([](AirProfile&) {}), "no error");
  EXPECT_THAT(with([](AirProfile& p) { std::swap(p.levels[3], p.levels[4]); }),
              HasSubstr("level 5 (3000 m): it follows 4000 m"));
  EXPECT_THAT(with([](AirProfile& p) { p.levels[2].share(Gas::o3) = -1e-9; }),
              HasSubstr("level 3 (2000 m): a share of o3"));
  EXPECT_THAT(with([](AirProfile& p) { p.levels[2].share(Gas::co2) = 0.2; }), HasSubstr("its gases sum to 1.1"));
  EXPECT_THAT(with([](AirProfile& p) { p.levels[0].temperature = 0; }), HasSubstr("a temperature of 0 K"));
  EXPECT_THAT(with([](AirProfile& p) { p.levels[1].pressure = 2e5; }), HasSubstr("level 2 (1000 m): 200000 Pa follow"));
  EXPECT_THAT(with([](AirProfile& p) { p.levels.resize(1); }), HasSubstr("a profile of 1 levels"));
  const auto scaling = [&](auto change) {
    ProfileScaling s;
    change(s);
    return message_of([&] { scaled(good, s); });
  };
  ProfileScaling humid;  // nitrogen makes room
  humid.water = 45;
  EXPECT_EQ(message_of([&] { scaled(standard_profile("midlatitude_summer"), humid); }), "no error");
  EXPECT_THAT(scaling([](ProfileScaling& s) { s.water = -1; }), HasSubstr("an amount of h2o of -1"));
  EXPECT_THAT(scaling([](ProfileScaling& s) { s.water = 2000; }), HasSubstr("share of h2o"));
  EXPECT_THAT(scaling([](ProfileScaling& s) { s.surface_pressure = 1000; }),
              HasSubstr("a surface pressure of 1000 Pa"));
  EXPECT_THAT(scaling([](ProfileScaling& s) { s.ozone = 300, s.at_ground[static_cast<size_t>(Gas::o3)] = 1e-7; }),
              HasSubstr("both a column and a share of o3"));
}

// Saturation over water is 12.272 hPa at 10 C and 23.373 hPa at 20 C (WMO-No. 8, Guide to Instruments, annex 4.B).
TEST(Profile, SaturatedWater) {
  EXPECT_NEAR(water_share(1, 101325, 283.15) * 1013.25, 12.27, 0.02);
  EXPECT_NEAR(water_share(0.5, 101325, 293.15) * 1013.25, 23.37 / 2, 0.02);
}

}  // namespace
}  // namespace suite::profile_test
