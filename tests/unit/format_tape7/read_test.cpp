// tape7: real files of MODTRAN 4, the layouts of other modes, and what is wrong with a file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/tape7/tape7.h"
#include "math/vec.h"
#include "tests/support/message_of.h"

namespace suite::format_tape7_read_test {
namespace {

using testing::HasSubstr;

const std::string kFolder = SUITE_TEST_DATA "/modtran/";

// Rows of 12010 and 14000 1/cm, typed from the file.
TEST(Tape7, HorizontalPathOfAKilometre) {
  const std::vector<Tape7Block> runs = read_tape7(kFolder + "path1000.tape7");
  ASSERT_EQ(runs.size(), 1u);
  const Tape7Block& run = runs[0];
  EXPECT_EQ(run.mode, Tape7Mode::radiance);
  EXPECT_TRUE(run.many_scatterings);
  ASSERT_EQ(run.wavenumber.size(), 2001u);
  EXPECT_EQ(run.wavenumber.front(), 12000);
  EXPECT_EQ(run.wavenumber.back(), 14000);
  EXPECT_EQ(run.transmittance().values.back(), 0.87279296);
  EXPECT_EQ(run.column("DEPTH").values.back(), 0.136);
  EXPECT_EQ(run.column("BBODY_T[K]").unit, "K");
  EXPECT_EQ(run.column("BBODY_T[K]").values.back(), 1088.928);
  const double nu2 = 14000.0 * 14000.0;
  EXPECT_EQ(run.column("SOL_SCAT").unit, "W/(m2 sr um)");
  EXPECT_NEAR(run.column("SOL_SCAT").values.back(), 3.0248e-8 * nu2, 1e-12);
  EXPECT_NEAR(run.path_radiance().back(), 3.0248e-8 * nu2, 1e-12);
  // The Sun above the air: 1450 W/(m2 um) at 0.714 um.
  EXPECT_EQ(run.column("TOA_SUN").unit, "W/(m2 um)");
  EXPECT_NEAR(run.column("TOA_SUN").values.back(), 7.3869e-6 * nu2, 1e-9);
  EXPECT_NEAR(run.two_way_transmittance().back(), 4.61 / 7.3869, 1e-9);
  ASSERT_TRUE(run.geometry);
  EXPECT_EQ(run.geometry->path_type, 2);
  EXPECT_EQ(run.geometry->observer_height, 0);
  EXPECT_NEAR(run.geometry->end_height, 17.53, 1e-9);
  EXPECT_NEAR(run.geometry->zenith, 89 * kDegree, 1e-15);
  EXPECT_EQ(run.geometry->range, 1000);
  EXPECT_FALSE(run.geometry->solar_zenith);  // given by date and place
}

// At 12003 1/cm and around, a product of the averages of the two ways misses the file's own two-way transmittance.
TEST(Tape7, TwoWaysAreNotAProduct) {
  const Tape7Block run = read_tape7(kFolder + "path1000.tape7")[0];
  const std::vector<double> both = run.two_way_transmittance();
  double worst = 0;
  for (size_t i = 0; i < both.size(); ++i) {
    const double down = run.column("SOL@OBS").values[i] / run.column("TOA_SUN").values[i];
    worst = std::max(worst, std::fabs(both[i] - down * run.transmittance().values[i]));
    EXPECT_LE(both[i], std::min(down, run.transmittance().values[i]) + 0.02);
  }
  EXPECT_GT(worst, 0.08);
}

TEST(Tape7, RadianceIsTheSumOfItsParts) {
  for (const char* name : {"path1000.tape7", "tape7-03", "tape7-05"}) {
    const Tape7Block run = read_tape7(kFolder + name)[0];
    const auto& total = run.column("TOTAL_RAD").values;
    double worst = 0, with_contained = 0;
    for (size_t i = 0; i < total.size(); ++i) {
      const auto of = [&](const char* column) { return run.column(column).values[i]; };
      const double sum = of("PTH_THRML") + of("SURF_EMIS") + of("SOL_SCAT") + of("GRND_RFLT");
      worst = std::max(worst, std::fabs(sum / total[i] - 1));
      with_contained = std::max(with_contained, std::fabs((sum + of("SING_SCAT")) / total[i] - 1));
    }
    EXPECT_LT(worst, 9e-5) << name;
    EXPECT_GT(with_contained, 1e-4) << name;
  }
}

TEST(Tape7, SlantPathAndPathToSpace) {
  const Tape7Block slant = read_tape7(kFolder + "tape7-03")[0], space = read_tape7(kFolder + "tape7-05")[0];
  EXPECT_EQ(slant.wavenumber.size(), 51u);
  EXPECT_FALSE(slant.many_scatterings);
  EXPECT_EQ(slant.transmittance().values[1], 0.74512768);
  EXPECT_NEAR(slant.column("SURF_EMIS").values[0], 4.8713e-7 * 2050.0 * 2050.0, 1e-12);
  ASSERT_TRUE(slant.geometry);
  EXPECT_EQ(slant.geometry->observer_height, 2000);
  EXPECT_EQ(slant.geometry->end_height, 10000);
  EXPECT_NEAR(*slant.geometry->range, 9235.9, 1e-9);
  ASSERT_TRUE(space.geometry);
  EXPECT_EQ(space.geometry->path_type, 3);
  EXPECT_NEAR(space.geometry->zenith, 20 * kDegree, 1e-15);
}

// Runs as the other modes lay them out.
const std::string kThermal =
    "T   6    2    1    0    0    0    0    0    0    0    1    0    0   0.000   0.00\n"
    "    FREQ  TOT_TRANS  PTH_THRML  THRML_SCT  SURF_EMIS   SOL_SCAT  SING_SCAT  GRND_RFLT  DRCT_RFLT  TOTAL_RAD  "
    "REF_SOL"
    "  SOL@OBS   DEPTH DIR_EM    TOA_SUN BBODY_T[K]\n"
    "  900.00 0.70000000 1.0000E-06 0.0000E+00 5.0000E-06                       1.0000E-07            6.1000E-06       "
    "  "
    "            0.357 1.0000               280.000\n"
    "  901.00 0.60000000 1.1000-101 0.0000E+00 5.0000E-06                       1.0000E-07            6.2000E-06       "
    "  "
    "            0.511 1.0000              ********\n"
    " -9999.\n";

TEST(Tape7, BlankFieldsKeepTheirColumns) {
  const Tape7Block run = parse_tape7(kThermal, "t.tp7")[0];
  EXPECT_EQ(run.mode, Tape7Mode::thermal_radiance);
  EXPECT_NEAR(run.column("GRND_RFLT").values[0], 0.081, 1e-12);
  EXPECT_NEAR(run.column("TOTAL_RAD").values[0], 6.1e-6 * 810000, 1e-12);
  EXPECT_EQ(run.column("DEPTH").values[1], 0.511);
  EXPECT_NEAR(run.column("PTH_THRML").values[1] / (1.1e-101 * 901 * 901), 1, 1e-12);
  EXPECT_TRUE(std::isnan(run.find("SOL_SCAT")->values[0]));
  EXPECT_EQ(run.path_radiance()[0], run.column("PTH_THRML").values[0]);
  EXPECT_THAT(message_of([&] { run.column("SOL_SCAT"); }),
              HasSubstr("t.tp7:3: error: column 'SOL_SCAT' is blank at 900"));
  EXPECT_THAT(message_of([&] { run.column("BBODY_T[K]"); }), HasSubstr("t.tp7:4: error"));
  EXPECT_THAT(message_of([&] { run.two_way_transmittance(); }), HasSubstr("'REF_SOL' is blank"));
}

TEST(Tape7, NumbersThatTouch) {
  const Tape7Block run =
      parse_tape7("  FREQ TOTAL   H2O  CO2+\n  CM-1 TRANS TRANS TRANS\n 1000.0.98760.12340.5000\n -9999.\n", "l")[0];
  EXPECT_EQ(run.wavenumber[0], 1000);
  EXPECT_EQ(run.transmittance().values[0], 0.9876);
  EXPECT_EQ(run.column("CO2+_TRANS").values[0], 0.5);
}

TEST(Tape7, ModesOfTransmittanceAndIrradiance) {
  const std::string text =
      "T   6    2    0    0\n"
      "    FREQ COMBIN    H2O   UMIX     N2    H2O\n    CM-1  TRANS  TRANS  TRANS   CONT   CONT\n"
      "   1000. 0.5000 0.6000 0.9000 1.0000 0.9260\n   1005. 0.5100 0.6100 0.9100 1.0000 0.9188\n -9999.\n"
      "    6    3    3    0\n"
      "    FREQ   TRANS     SOL TR  SOLAR\n   1000. 0.5000 1.00E-08 2.00E-08    0.693\n -9999.\n";
  const std::vector<Tape7Block> runs = parse_tape7(text, "two.tp7");
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].mode, Tape7Mode::transmittance);
  EXPECT_EQ(runs[0].transmittance().values[1], 0.51);
  EXPECT_EQ(runs[0].column("H2O_TRANS").values[0], 0.6);
  EXPECT_EQ(runs[0].column("H2O_CONT").values[0], 0.926);
  EXPECT_EQ(runs[1].mode, Tape7Mode::irradiance);
  EXPECT_EQ(runs[1].transmittance().values[0], 0.5);
  EXPECT_NEAR(runs[1].column("SOL_TR").values[0], 0.01, 1e-15);
  EXPECT_EQ(runs[1].column("DEPTH").values[0], 0.693);
  // What a mode does not hold.
  EXPECT_THAT(message_of([&] { runs[0].path_radiance(); }),
              HasSubstr("two.tp7:2:5: error: no column 'PTH_THRML' in a run of mode transmittance (IEMSCT 0)"));
  EXPECT_THAT(message_of([&] { runs[1].path_radiance(); }), HasSubstr("the Sun's irradiance (IEMSCT 3)"));
}

// Names of version 6; whether parts contain others is told by the total only.
TEST(Tape7, PathRadianceOfVersion6) {
  const std::string header =
      "    FREQ  TOT_TRANS   THRML_EM  THRML_SCT  SURF_EMIS  MULT_SCAT  SING_SCAT  GRND_RFLT  TOTAL_RAD\n";
  const std::string parts = " 1000.00 0.50000000 1.0000E-06 2.0000E-07 5.0000E-06 3.0000E-07 1.0000E-07 4.0000E-07 ";
  const auto radiance = [&](const char* total) {
    return parse_tape7(header + parts + total + "\n -9999.\n", "six.tp7")[0].path_radiance()[0] / 1e6;
  };
  EXPECT_NEAR(radiance("6.7000E-06"), 1.3e-6, 1e-15);
  EXPECT_NEAR(radiance("6.9000E-06"), 1.5e-6, 1e-15);
  EXPECT_NEAR(radiance("6.8000E-06"), 1.4e-6, 1e-15);
  EXPECT_NEAR(radiance("7.0000E-06"), 1.6e-6, 1e-15);
  EXPECT_THAT(message_of([&] { radiance("9.0000E-06"); }), HasSubstr("no sum of the path's parts"));
}

TEST(Tape7, SolarAnglesOfCards) {
  std::string text = read_text(kFolder + "tape7-03");
  text.replace(text.find("    0    0    1    0"), 20, "    2    2    1    0");
  text.replace(text.find("  25.00000   0.00000"), 20, "  25.00000  40.00000");
  const Tape7Geometry g = *parse_tape7(text, "t")[0].geometry;
  EXPECT_NEAR(*g.relative_azimuth, 25 * kDegree, 1e-15);
  EXPECT_NEAR(*g.solar_zenith, 40 * kDegree, 1e-15);
  // Cards of another run say nothing.
  text.replace(text.find("    2050.0    2100.0"), 20, "    1050.0    1100.0");
  EXPECT_FALSE(parse_tape7(text, "t")[0].geometry);
}

TEST(Tape7, FaultsAreTold) {
  const std::string good = read_text(kFolder + "tape7-03");
  const auto told = [](const std::string& text) { return message_of([&] { parse_tape7(text, "f.tp7"); }); };
  EXPECT_THAT(told(good.substr(0, 5000)), HasSubstr("the spectrum is cut: no line -9999 ends it"));
  EXPECT_THAT(told(good.substr(0, 5000)), HasSubstr("f.tp7:"));
  EXPECT_THAT(told(good.substr(0, 300)), HasSubstr("there is no spectrum"));
  const auto with = [&](const std::string& old, const std::string& replacement) {
    std::string t = good;
    t.replace(t.find(old), old.size(), replacement);
    return told(t);
  };
  EXPECT_THAT(with(" 2052.00 ", " 2050.50 "), HasSubstr("f.tp7:14:2: error: wavenumbers do not ascend"));
  EXPECT_THAT(
      told("    FREQ  LOS  TOT_TRANS  PTH_THRML\n  900.00    1  0.5  1.0000E-06\n  900.00    2  0.5  1.0000E-06\n"
           " -9999.\n"),
      HasSubstr("several lines of sight"));
  EXPECT_THAT(with("0.88372636", "0.883x2636"), HasSubstr("'0.883x2636' is not a number"));
  EXPECT_THAT(with("0.88372636", "0.88372636 0.1"), HasSubstr("more numbers (17) than columns (16)"));
  EXPECT_THAT(with("T F 6    2    2", "T F 6    2    0"), HasSubstr("not the columns of mode 0"));
  EXPECT_THAT(with("    FREQ", " WAVLEN"), HasSubstr("over wavelength"));
  EXPECT_THAT(told("    FREQ  TOT_TRANS  PTH_THRML\n  900.00                           1.0000E-06\n -9999.\n"),
              HasSubstr("f.tp7:2:36: error: this number stands under no column"));
  EXPECT_THAT(told("    FREQ  TOT_TRANS\n -9999.\n"), HasSubstr("without a row"));
  EXPECT_THAT(told("    FREQ\n  1.0\n -9999.\n"), HasSubstr("no column beside FREQ"));
}

}  // namespace
}  // namespace suite::format_tape7_read_test
