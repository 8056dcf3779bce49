// JSON of MODTRAN 6 as documented.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/tape7/modtran6.h"
#include "math/vec.h"
#include "tests/support/message_of.h"

namespace suite::format_tape7_modtran6_test {
namespace {

using testing::HasSubstr;

const std::string kInput =
    R"("MODTRANINPUT": {"RTOPTIONS": {"IMULT": "RT_DISORT"}, "SPECTRAL": {"V1": 1000, "V2": 1002, "DV": 2},
  "GEOMETRY": {"ITYPE": 2, "H1ALT": 3, "H2ALT": 1, "OBSZEN": 120, "HRANGE": 4, "IPARM": 12, "PARM1": 90, "PARM2": 40}})";
const std::string kSpectra = R"("TOT_TRANS": [0.5, 0.6], "THRML_EM": [1e-6, 1e-6], "THRML_SCT": [0, 0],
  "SURF_EMIS": [2e-6, 2e-6], "MULT_SCAT": [3e-7, 3e-7], "SING_SCAT": [1e-7, 1e-7], "GRND_RFLT": [0, 0],
  "TOTAL_RAD": [3.3e-6, 3.3e-6], "SOL_AT_OBS": [1e-6, 1e-6], "REF_SOL": [1e-6, 2e-6], "TOA_RAD": [4e-6, 4e-6])";

std::string file(const std::string& input, const std::string& kind, const std::string& spectra) {
  return "{\"MODTRAN\": [{" + input + (input.empty() ? "" : ",\n") + "\"MODTRANOUTPUT\": {\"SPECTRA\": {\"" + kind +
         "\": {" + spectra + "}}}}]}";
}

TEST(Modtran6, Radiance) {
  for (const bool own_wavenumbers : {false, true}) {
    const std::string spectra = own_wavenumbers ? "\"FREQ\": [1000, 1002], " + kSpectra : kSpectra;
    const Tape7Block run = parse_modtran6(file(kInput, "RADIANCE", spectra), "six.json")[0];
    EXPECT_EQ(run.mode, Tape7Mode::radiance);
    EXPECT_TRUE(run.many_scatterings);
    EXPECT_EQ(run.wavenumber[1], 1002);
    EXPECT_EQ(run.transmittance().values[0], 0.5);
    EXPECT_NEAR(run.path_radiance()[0], 1.3, 1e-12);
    EXPECT_NEAR(run.two_way_transmittance()[1], 0.5, 1e-12);
    EXPECT_EQ(run.column("SOL@OBS").unit, "W/(m2 um)");
    ASSERT_TRUE(run.geometry);
    EXPECT_EQ(run.geometry->range, 4000);
    EXPECT_NEAR(run.geometry->zenith, 120 * kDegree, 1e-15);
    EXPECT_NEAR(*run.geometry->solar_zenith, 40 * kDegree, 1e-15);
  }
}

TEST(Modtran6, Transmittance) {
  const Tape7Block run = parse_modtran6(
      file("", "TRANSMITTANCE", R"("FREQ": [5, 6], "TOT_TRANS": [0.1, 0.2], "TRANS_H2O": [0.3, 0.4])"), "t")[0];
  EXPECT_EQ(run.mode, Tape7Mode::transmittance);
  EXPECT_EQ(run.transmittance().values[1], 0.2);
  EXPECT_FALSE(run.geometry);
  EXPECT_THAT(message_of([&] { run.path_radiance(); }),
              HasSubstr("no column 'PTH_THRML' in a run of mode transmittance"));
}

TEST(Modtran6, Faults) {
  const auto told = [](const std::string& text) { return message_of([&] { parse_modtran6(text, "six.json"); }); };
  EXPECT_THAT(told("{}"), HasSubstr("MODTRAN"));
  EXPECT_THAT(told(R"({"MODTRAN": []})"), HasSubstr("no case"));
  EXPECT_THAT(told(R"({"MODTRAN": [{"MODTRANINPUT": {}}]})"), HasSubstr("a case without its output"));
  EXPECT_THAT(told(file("", "FLUX", "")), HasSubstr("no spectra in the output"));
  EXPECT_THAT(told(file("", "RADIANCE", "\"TOT_TRANS\": [1]")), HasSubstr("no wavenumbers"));
  EXPECT_THAT(told(file("", "RADIANCE", "\"FREQ\": [1, 2], \"TOT_TRANS\": [1]")),
              HasSubstr("2 wavenumbers for 1 values"));
  EXPECT_THAT(told(file("", "RADIANCE", "\"FREQ\": [2, 1], \"TOT_TRANS\": [1, 1]")), HasSubstr("do not ascend at 1"));
  EXPECT_THAT(told(file("", "RADIANCE", "\"A\": [1, 2], \"B\": [1]")),
              HasSubstr("the list B has 1 values, the first 2"));
  EXPECT_THAT(told(file("", "RADIANCE", "\"A\": [[1, 2]]")), HasSubstr("one line of sight"));
  EXPECT_THAT(told(file("", "RADIANCE", "\"A\": [\"x\"]")), HasSubstr("six.json:1:"));
}

}  // namespace
}  // namespace suite::format_tape7_modtran6_test
