#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/hitran/hitran.h"
#include "support/message_of.h"

namespace suite::format_hitran_read_test {
namespace {

using testing::HasSubstr;

constexpr const char* kLines =
    " 11 1554.352490 9.750E-20 1.082E+01.09850.488  136.16390.77-.001840          0 1 0\n"
    " 22 2283.488000 3.000E-20 2.000E+02.07130.095    0.78000.75-.002900\n"
    "291  100.000000 1.000E-20 1.000E+00.10000.100    0.00000.500.0000000\n"
    " 1A 1500.000000 1.000E-24 1.082E+01.09000.400  100.00000.700.000000\n";

TEST(Hitran, FieldsOfLines) {
  const std::vector<LineGas> gases = parse_hitran(kLines, "l.par");
  ASSERT_EQ(gases.size(), 2u);  // molecule 29 is none of ours
  EXPECT_EQ(gases[0].gas, Gas::h2o);
  ASSERT_EQ(gases[0].lines.size(), 2u);
  EXPECT_EQ(gases[0].lines[0].isotopologue, 11);
  const SpectralLine& line = gases[0].lines[1];
  EXPECT_DOUBLE_EQ(line.wavenumber_cm, 1554.35249);
  EXPECT_DOUBLE_EQ(line.intensity, 9.75e-20);
  EXPECT_DOUBLE_EQ(line.air_width_cm, 0.0985);
  EXPECT_DOUBLE_EQ(line.self_width_cm, 0.488);
  EXPECT_DOUBLE_EQ(line.lower_energy_cm, 136.1639);
  EXPECT_DOUBLE_EQ(line.exponent, 0.77);
  EXPECT_DOUBLE_EQ(line.shift_cm, -0.00184);
  EXPECT_EQ(gases[1].gas, Gas::co2);
  EXPECT_EQ(gases[1].lines[0].isotopologue, 2);
}

TEST(Hitran, RefusesWithThePlace) {
  const auto message = [](const char* text) { return message_of([&] { parse_hitran(text, "l.par"); }); };
  EXPECT_THAT(message(" 11 1554.35\n"), HasSubstr("l.par:1:2: error: a line of 11 characters"));
  EXPECT_THAT(message(" 11 155x.352490 9.750E-20 1.082E+01.09850.488  136.16390.77-.001840\n"),
              HasSubstr("l.par:1:4: error: wavenumber '155x.352490'"));
  EXPECT_THAT(message(" 1? 1554.352490 9.750E-20 1.082E+01.09850.488  136.16390.77-.001840\n"), HasSubstr("l.par:1:3"));
  EXPECT_THAT(message("291 1554.352490 9.750E-20 1.082E+01.09850.488  136.16390.77-.001840\n"),
              HasSubstr("holds no line"));
}

TEST(Hitran, PartitionSumsAndContinuum) {
  const auto ratio = parse_partition_sum("200 80\n290 130\n300 140\n", "q.txt");
  EXPECT_NEAR(ratio(296), 1, 1e-12);
  EXPECT_NEAR(ratio(245), 105.0 / 136, 1e-12);
  EXPECT_THAT(message_of([&] { ratio(100); }), HasSubstr("it reaches from 200 to 300 K"));
  EXPECT_THAT(message_of([] { parse_partition_sum("200 80\n250 130\n", "q.txt"); }), HasSubstr("do not reach 296 K"));
  const WaterContinuum c = parse_water_continuum(
      "wavenumber_cm,self,foreign,self_exponent\n-20,1e-22,2e-24,4\n-10,3e-22,4e-24,5\n0,5e-22,6e-24,6\n", "c.csv");
  EXPECT_EQ(c.first_cm, -20);
  EXPECT_EQ(c.step_cm, 10);
  EXPECT_EQ(c.self[1], 3e-22);
  EXPECT_EQ(c.foreign[2], 6e-24);
  EXPECT_EQ(c.exponent[0], 4);
  EXPECT_THAT(message_of([] {
                parse_water_continuum(
                    "wavenumber_cm,self,foreign,self_exponent\n0,1e-22,2e-24,4\n10,3e-22,4e-24,5\n25,0,0,0\n", "c.csv");
              }),
              HasSubstr("c.csv:4:1: error: wavenumber 25"));
  EXPECT_THAT(message_of([] { parse_water_continuum("v,self\n", "c.csv"); }), HasSubstr("other columns"));
}

}  // namespace
}  // namespace suite::format_hitran_read_test
