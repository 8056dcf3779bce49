// Tables of the spectral responses of several bands, as agencies publish them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/curve/curve.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_curve_responses_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Responses : public ::testing::Test {
 protected:
  std::vector<NamedCurve> read(const std::string& text) {
    write_file(folder_ / "r.csv", text);
    return read_responses(folder_ / "r.csv");
  }
  std::string fault(const std::string& text) {
    return message_of([&] { read(text); });
  }
  TempFolder folder_;
};

TEST_F(Responses, HaveAColumnABand) {
  for (const char separator : {',', ';', '\t'}) {
    std::string text =
        "# measured\r\n\"SR_WL (nm)\",S2A B1, S2A B2\r\n440,0,0\r\n445,0.8,0\r\n450,0,0.4\r\n455,0,1\r\n460,0,0.2\r\n";
    for (char& c : text)
      if (c == ',') c = separator;
    const std::vector<NamedCurve> all = read(text);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[0].name, "S2A B1");
    EXPECT_EQ(all[1].name, "S2A B2");
    // Zeros around a band are no part of it, those beside it are.
    EXPECT_DOUBLE_EQ(all[0].curve.low_um(), 0.44);
    EXPECT_DOUBLE_EQ(all[0].curve.high_um(), 0.45);
    EXPECT_DOUBLE_EQ(all[1].curve.low_um(), 0.445);
    EXPECT_DOUBLE_EQ(all[1].curve.high_um(), 0.46);
    EXPECT_DOUBLE_EQ(all[0].curve.at(0.4425), 0.4);
    EXPECT_DOUBLE_EQ(all[1].curve.at(0.4525), 0.7);
  }
}

// Cells that are empty shifted all others to the left where separators were taken together.
TEST_F(Responses, EmptyCellsSayNothing) {
  const std::vector<NamedCurve> all = read("wavelength um,a,b\n0.4,1,\n0.5,,2\n0.6,3,4\n");
  EXPECT_DOUBLE_EQ(all[0].curve.at(0.5), 2);
  EXPECT_DOUBLE_EQ(all[1].curve.low_um(), 0.5);
  EXPECT_DOUBLE_EQ(all[1].curve.at(0.6), 4);
}

TEST_F(Responses, FaultsHaveTheirPlace) {
  EXPECT_THAT(fault("wavelength,a\n400,1\n"), AllOf(HasSubstr("r.csv:1"), HasSubstr("is no header")));  // which unit?
  EXPECT_THAT(fault("400,1\n401,1\n"), HasSubstr("is no header"));
  EXPECT_THAT(fault("nm,a,\n400,1,2\n"), HasSubstr("column 3 has no name"));
  EXPECT_THAT(fault("nm,a\n400,1,2\n"), AllOf(HasSubstr("r.csv:2"), HasSubstr("a row of 3 cells, the header names 2")));
  EXPECT_THAT(fault("nm,a\n400,x\n"), HasSubstr("'x' is no number"));
  EXPECT_THAT(fault("nm,a\n400,nan\n"), HasSubstr("'nan' is no number"));
  EXPECT_THAT(fault("nm,a\n400,1\n400,1\n"), HasSubstr("sort the rows"));
  EXPECT_THAT(fault("um,a\n400000,1\n"), HasSubstr("is the unit right?"));
  EXPECT_THAT(fault("nm,a\n400,0\n401,0\n"), HasSubstr("band 'a' has no response other than 0"));
  EXPECT_THAT(fault(""), HasSubstr("holds no table"));
}

}  // namespace
}  // namespace suite::format_curve_responses_test
