#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/profile/profile.h"
#include "support/message_of.h"

namespace suite::format_profile_read_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kSounding =
    "<PRE>\n72451 DDC Dodge City Observations at 12Z 01 May 2010\n\n"
    "-----------------------------------------------------------------------------\n"
    "   PRES   HGHT   TEMP   DWPT   RELH   MIXR   DRCT   SKNT   THTA   THTE   THTV\n"
    "    hPa     m      C      C      %    g/kg    deg   knot     K      K      K \n"
    "-----------------------------------------------------------------------------\n"
    " 1000.0    113                                                               \n"
    "  925.0    790   12.4    9.4     82   8.07    170     14  292.1  315.4  293.5\n"
    "  850.0   1500   10.0    2.0     58   5.22    200     20  296.6  312.4  297.5\n"
    "  500.0   5740  -14.7  -40.7      9   0.20    240     50  315.0  315.8  315.0\n"
    "  100.0  16260  -62.1                           250     60  407.2         407.2\n"
    "</PRE><H3>Station information and sounding indices</H3>\n";

TEST(Profile, TableWithUnits) {
  const ReadProfile r = parse_profile(
      "# mine\nheight_km,temperature_c,pressure_hpa,relative_humidity_percent,o3_ppmv,so2_ppbv\n"
      "10,-50,265,20,0.1,0\n1, 10, 900,50,0.03,2 # second\n0,20,1013.25,60,0.02,5\n",
      "p.csv", "midlatitude_summer");
  const AirLevel& ground = r.profile.levels[0];
  EXPECT_EQ(ground.height, 0);
  EXPECT_NEAR(ground.temperature, 293.15, 1e-9);
  EXPECT_NEAR(ground.pressure, 101325, 1e-9);
  EXPECT_NEAR(ground.share(Gas::h2o), 0.6 * 23.37 / 1013.25, 2e-5);
  EXPECT_NEAR(ground.share(Gas::so2), 5e-9, 1e-15);
  EXPECT_NEAR(r.profile.levels[1].share(Gas::o3), 3e-8, 1e-15);
  // What is not given: the other gases and what is above.
  const AirProfile standard = standard_profile("midlatitude_summer");
  EXPECT_EQ(ground.share(Gas::ch4), standard.at(0).share(Gas::ch4));
  EXPECT_EQ(r.profile.levels.back().height, 120000);
  EXPECT_NEAR(r.profile.levels[3].pressure / standard.at(11000).pressure, 26500 / standard.at(10000).pressure, 1e-9);
  EXPECT_THAT(r.notes, ElementsAre("co2, n2o, co, ch4, o2, n2, no, no2, nh3, hno3 from midlatitude_summer",
                                   "above 10000 m the air is that of midlatitude_summer"));
}

TEST(Profile, Sounding) {
  const ReadProfile r = parse_profile(kSounding, "ddc.txt");
  const auto& levels = r.profile.levels;
  EXPECT_EQ(levels[0].height, 790);
  EXPECT_NEAR(levels[0].pressure, 92500, 1e-9);
  EXPECT_NEAR(levels[0].temperature, 285.55, 1e-9);
  // The file's own mixing ratios, 8.07 and 5.22 g/kg.
  EXPECT_NEAR(levels[0].share(Gas::h2o), 8.07e-3 / (8.07e-3 + 0.62197), 1e-4);
  EXPECT_NEAR(levels[1].share(Gas::h2o), 5.22e-3 / (5.22e-3 + 0.62197), 1e-4);
  EXPECT_EQ(levels[3].share(Gas::h2o), standard_profile("us_standard").at(16260).share(Gas::h2o));
  ASSERT_EQ(r.notes.size(), 3u);
  EXPECT_THAT(r.notes[0], HasSubstr("1 rows without height or temperature"));
  EXPECT_THAT(r.notes[1], HasSubstr("h2o (at 1 of 4 levels)"));
}

TEST(Profile, RefusesWithThePlace) {
  const auto message = [](const char* text) { return message_of([&] { parse_profile(text, "p.csv"); }); };
  EXPECT_THAT(message("height_m,pressure_hpa,temp_k\n"), HasSubstr("p.csv:1:23: error: unknown column 'temp_k'"));
  EXPECT_THAT(message("height_m,pressure_hpa\n"), HasSubstr("no column of temperature_k"));
  EXPECT_THAT(message("height_m,pressure_hpa,temperature_k,h2o_ppmv,dew_point_c\n"),
              HasSubstr("a second column of water"));
  EXPECT_THAT(message("height_m,pressure_hpa,temperature_k\n0,1000,280\n5,900\n"),
              HasSubstr("p.csv:3:1: error: a row of 2"));
  EXPECT_THAT(message("height_m,pressure_hpa,temperature_k\n0,1000,280\n9,900,270\n5,800,260\n"),
              HasSubstr("p.csv:4:1: error: a height of 5 m next to 9 m"));
  EXPECT_THAT(message("height_m,pressure_hpa,temperature_k,co2_ppmv\n0,1000,280,-4\n"),
              HasSubstr("p.csv:2:12: error: -4 is negative"));
  EXPECT_THAT(message("height_m,pressure_hpa,temperature_k\n0,1000,280\n"), HasSubstr("a profile of 1 levels"));
  EXPECT_THAT(message("height_m,pressure_hpa,temperature_k\n0,1000,280\n1000,1100,270\n"),
              HasSubstr("p.csv:3:1: error: 110000 Pa follow 100000 Pa"));
  EXPECT_THAT(message(""), HasSubstr("holds no profile"));
}

}  // namespace
}  // namespace suite::format_profile_read_test
