// Responses in netCDF-4 and HDF5: layouts of agencies written by the netCDF library (tests/data/responses/README.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/curve/curve.h"
#include "formats/hdf5/h5.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_curve_response_files_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kData = SUITE_SOURCE_DIR "/tests/data/responses/";

TEST(ResponseFiles, BandsHaveWavelengthsOfTheirOwn) {
  const std::vector<NamedCurve> all = read_responses(kData + "own_wavelengths.nc");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].name, "B1");
  EXPECT_NEAR(all[0].curve.at(0.442), 1, 1e-7);
  EXPECT_NEAR(all[0].curve.at(0.4415), 0.75, 1e-6);
  EXPECT_NEAR(all[1].curve.low_um(), 0.6, 1e-9);
  EXPECT_NEAR(all[1].curve.high_um(), 0.604, 1e-7);  // what fills up the row is no point
}

TEST(ResponseFiles, BandsShareWavelengthsAndHaveNames) {
  const std::vector<NamedCurve> all = read_responses(kData + "shared_wavelengths.nc");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].name, "blue");
  EXPECT_EQ(all[1].name, "violet");
  EXPECT_NEAR(all[0].curve.at(0.43), 1, 1e-9);  // stored as 1000, times 0.001
  EXPECT_NEAR(all[1].curve.at(0.42), 1, 1e-9);
  EXPECT_NEAR(all[1].curve.low_um(), 0.40, 1e-12);
}

TEST(ResponseFiles, EachBandIsAVariable) {
  const std::vector<NamedCurve> all = read_responses(kData + "variable_a_band.nc");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].name, "S8_response");
  EXPECT_NEAR(all[0].curve.at(1e4 / 850), 1, 1e-7);
  EXPECT_NEAR(all[1].curve.at(1e4 / 900), 1, 1e-7);
  EXPECT_NEAR(all[1].curve.high_um(), 1e4 / 850, 1e-9);
}

TEST(ResponseFiles, ClassicNetCdfIsRefusedByName) {
  EXPECT_THAT(message_of([] { read_responses(kData + "classic.nc"); }),
              AllOf(HasSubstr("classic netCDF"), HasSubstr("nccopy -k nc4")));
}

class MadeResponses : public ::testing::Test {
 protected:
  struct Part {
    const char* name;
    std::vector<double> values;
    const char* units;
    size_t width = 1;
  };
  std::string fault(const std::vector<Part>& parts) {
    const std::string path = folder_ / strf("%d.nc", ++files_);
    h5::Writer w(path, path);
    for (const Part& p : parts) w.put(p.name, p.values, p.units, p.width);
    w.close();
    return message_of([&] { read_responses(path); });
  }
  TempFolder folder_;
  int files_ = 0;
};

TEST_F(MadeResponses, FaultsNameTheVariableAndTheCure) {
  const Part nm{"/wavelength", {400, 410, 420}, "nm"}, one{"/response", {0, 1, 0}, "1"};
  EXPECT_EQ(fault({nm, one}), "no error");
  EXPECT_THAT(fault({one}), HasSubstr("has no variable of wavelengths"));
  EXPECT_THAT(fault({nm}), HasSubstr("has no variable of responses along '/wavelength'"));
  EXPECT_THAT(fault({{"/wavelength", {400, 410, 420}, "1"}, one}),
              AllOf(HasSubstr("'/wavelength' has the units '1'"), HasSubstr("ncatted")));
  EXPECT_THAT(fault({nm, {"/wavelength_out", {1, 2, 3}, "nm"}, one}), HasSubstr("several variables of wavelengths"));
  EXPECT_THAT(fault({nm, {"/a_srf", {0, 1, 0, 0, 1, 0}, "1", 3}, {"/b_srf", {0, 1, 0, 0, 1, 0}, "1", 3}}),
              HasSubstr("several variables of responses: '/a_srf', '/b_srf'"));
  EXPECT_THAT(fault({{"/wavelength", {400, 420, 410}, "nm"}, one}), HasSubstr("wavelength 0.41 um follows 0.42 um"));
  EXPECT_THAT(fault({{"/wavelength", {400, 410, 420}, "m"}, one}), HasSubstr("are the units right?"));
  EXPECT_THAT(fault({nm, {"/response", {0, 0, 0}, "1"}}), HasSubstr("no response other than 0"));
  EXPECT_THAT(fault({nm, {"/response", {0, 1, 0, 0, 1, 0, 0, 1, 0}, "1", 3}}),
              HasSubstr("as many bands as wavelengths"));
}

}  // namespace
}  // namespace suite::format_curve_response_files_test
