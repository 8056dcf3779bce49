#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "base/params.h"
#include "formats/curve/curve.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_curve_read_test {
namespace {

using ::testing::HasSubstr;

class CurveFile : public ::testing::Test {
 protected:
  Curve read(const std::string& text, const CurveOptions& options = {}) {
    write_file(folder_ / "c.txt", text);
    return read_curve(folder_ / "c.txt", options);
  }
  std::string fault(const std::string& text, const CurveOptions& options = {}) {
    return message_of([&] { read(text, options); });
  }
  TempFolder folder_;
};

TEST_F(CurveFile, TwoColumnsWithCommentsAndCarriageReturns) {
  const Curve c = read("# soil\r\n0.4 0.1\r\n0.8\t0.3\r\n");
  EXPECT_DOUBLE_EQ(c.at(0.6), 0.2);
  EXPECT_EQ(c.outside(), Outside::error);
}

TEST_F(CurveFile, CsvWithHeaderInNanometresAndSecondColumn) {
  const Curve c = read("wavelength (nm),a,b\n400,0.1,0.5\n800,0.3,0.7\n", {Outside::hold, 2, 0.5, {}});
  EXPECT_DOUBLE_EQ(c.low_um(), 0.4);
  EXPECT_DOUBLE_EQ(c.at(0.8), 0.35);
  EXPECT_DOUBLE_EQ(c.at(5), 0.35);
}

TEST_F(CurveFile, EcostressHeaderPercentAndDescending) {
  const Curve c =
      read("Name: x\nX Units: Wavelength (micrometers)\nY Units: Reflectance (percent)\n\n 14.0\t 1.0\n 2.0\t 50.0\n");
  EXPECT_DOUBLE_EQ(c.low_um(), 2);
  EXPECT_DOUBLE_EQ(c.at(2), 0.5);
  EXPECT_DOUBLE_EQ(c.at(14), 0.01);
}

TEST_F(CurveFile, EveryMarkOfAComment) {
  for (const char* mark : {"#", ";", "!", "%", ";;", " ; "}) {
    const Curve c = read(std::string(mark) + " RSR 0.4\n0.3 0.1\n" + mark + " BAND 2\n0.6 0.2\n2.6 0.3\n");
    EXPECT_EQ(c.wavelength_um().size(), 3u) << mark;
  }
}

// USGS splib07: -1.23e34 at the ends and at 1.35 and 1.4 um.
TEST_F(CurveFile, MarksOfDeletedChannelsAreLeftOut) {
  const std::string rows = "0.35 -1.2300000e+034\n0.5 0.28\n1.3 0.25\n1.35 -1.23e34\n1.4 -1.23e34\n1.5 0.21\n2.5 0.1\n";
  std::string said;
  CurveOptions options;
  options.outside = Outside::hold;
  options.on_warning = [&](const std::string&, const std::string& what) { said = what; };
  const Curve c = read(rows, options);
  EXPECT_DOUBLE_EQ(c.low_um(), 0.5);
  EXPECT_DOUBLE_EQ(c.at(1.4), 0.23);
  EXPECT_FALSE(c.covers(0.36, 0.42));  // nothing is held beyond an end that is marked
  EXPECT_TRUE(c.covers(0.55, 0.65));
  EXPECT_THAT(said, HasSubstr("3 of 7 values are marks of deleted channels (-1.23e34; 0.35 to 0.35, 1.35 to 1.4 um)"));
  EXPECT_THAT(fault("0.4 -1.23e34\n0.5 -1.23e34\n"), HasSubstr("every value is the mark of a deleted channel"));
  // A scale does not hide the mark.
  options.scale = 1e-10;
  EXPECT_DOUBLE_EQ(read(rows, options).low_um(), 0.5);
}

TEST_F(CurveFile, EmissivitiesOfNearlyOneAreOne) {
  std::string ems = "1\n";
  for (int k = 0; k < 91; ++k) ems += "1\n";
  write_file(folder_ / "c.ems", ems + "CURVE_BEGIN\n8 1.0000000000000007\n14 -1e-12\nCURVE_END\n");
  const Curve c = read_curve(folder_ / "c.ems", {});
  EXPECT_EQ(c.min(), 0);
  EXPECT_EQ(c.max(), 1);
}

// Rows that used to be dropped as headers, and numbers that were read as two.
TEST_F(CurveFile, NoRowIsLostOrMisread) {
  const Curve marked = read(
      "\xEF\xBB\xBF"
      "0.4 0.1\n0.6 0.5\n0.8 0.3\n");
  EXPECT_DOUBLE_EQ(marked.low_um(), 0.4);
  const Curve noted = read("0.4 0.1 # first\n0.8 0.3 ! last\n");
  EXPECT_DOUBLE_EQ(noted.low_um(), 0.4);
  EXPECT_DOUBLE_EQ(noted.high_um(), 0.8);
  EXPECT_THAT(fault("0.4 n/a\n0.6 0.1\n0.8 0.3\n"), HasSubstr("c.txt:1:1: error: a row that is not numbers"));
  for (const char* commas : {"nm\n400;0,2\n700;0,5\n", "nm\n400 0,2\n700 0,5\n", "nm\n400\t0,2\n", "400,5; 0.2\n"})
    EXPECT_THAT(fault(commas), HasSubstr("a comma within a number")) << commas;
  for (const char* points :
       {"0.4, 0.2\n0.7, 0.5\n", "0.4,0.2,0.3\n", " 0.4,0.2 ,0.3 \r\n", "0.4\t,0.2\n", "0.4 ; 0.2\n"})
    EXPECT_DOUBLE_EQ(read(points).at(0.4), 0.2) << points;
}

TEST_F(CurveFile, FaultsAreLocated) {
  EXPECT_THAT(fault("0.4 0.1\n0.5 x\n"), HasSubstr("c.txt:2:1: error: a row that is not numbers"));
  EXPECT_THAT(fault("0.4 0.1\n0.5\n"), HasSubstr(":2:1: error: a row of 1 numbers"));
  EXPECT_THAT(fault("0.4 0.1\n0.4 0.2\n"), HasSubstr(":2:1: error: wavelength 0.4 um is given twice"));
  EXPECT_THAT(fault("0.4 0.1\n0.6 0.2\n0.5 0.3\n"), HasSubstr(":3:1: error: wavelengths are not monotonic"));
  EXPECT_THAT(fault("0.4 nan\n"), HasSubstr("not finite"));
  EXPECT_THAT(fault("400 0.1\n-3 0.2\n"), HasSubstr("not between"));
  EXPECT_THAT(fault("hello\n"), HasSubstr("holds no rows"));
  EXPECT_THAT(fault(""), HasSubstr("holds no rows"));
  EXPECT_THAT(fault(std::string("0.4 0.1\n\0", 9)), HasSubstr("byte 8: error: is not a text file"));
  EXPECT_THAT(message_of([&] { read_curve(folder_.path(), {}); }), HasSubstr("is a directory"));
}

TEST_F(CurveFile, EnviSpectralLibrary) {
  write_file(folder_ / "l.hdr",
             "ENVI\ndescription = {two\nspectra}\nsamples = 3\nlines = 2\nbands = 1\ndata type = 4\nfile type = ENVI "
             "Spectral Library\n"
             "wavelength units = Nanometers\nspectra names = {dark, bright}\nwavelength = {400, 500,\n 800}\n");
  const float values[6] = {0.1f, 0.2f, 0.3f, 0.5f, 0.6f, 0.75f};
  write_file(folder_ / "l.sli", std::as_bytes(std::span(values)));
  EXPECT_NEAR(read_curve(folder_ / "l.sli", {}).at(0.8), 0.3, 1e-7);
  CurveOptions options;
  options.spectrum = "bright";
  EXPECT_DOUBLE_EQ(read_curve(folder_ / "l.sli", options).at(0.8), 0.75);
  options.spectrum = "2";
  EXPECT_DOUBLE_EQ(read_curve(folder_ / "l.sli", options).at(0.4), 0.5);
  options.spectrum = "brigth";
  EXPECT_THAT(message_of([&] { read_curve(folder_ / "l.sli", options); }), HasSubstr("did you mean 'bright'?"));
  EXPECT_EQ(read_curve_family(folder_ / "l.sli", {}).size(), 2u);
  write_file(folder_ / "l.sli", std::as_bytes(std::span(values, 5)));
  EXPECT_THAT(message_of([&] { read_curve(folder_ / "l.sli", {}); }),
              HasSubstr("has 20 bytes, its header declares 24"));
}

TEST_F(CurveFile, DirsigEmissivityBothLayouts) {
  std::string head = "2\n";
  for (int k = 0; k < 91; ++k) head += "1.0\n";
  write_file(folder_ / "new.ems", head + "CURVE_BEGIN\t\n0.4\t0.9\n0.8\t0.7\nCURVE_BEGIN\n0.4 0.5\n");
  CurveOptions options;
  EXPECT_NEAR(read_curve(folder_ / "new.ems", options).at(0.6), 0.2, 1e-12);
  options.spectrum = "2";
  EXPECT_DOUBLE_EQ(read_curve(folder_ / "new.ems", options).at(0.4), 0.5);
  std::string old = head;
  for (int c = 0; c < 2; ++c) {
    old += strf("%d\n", c);
    for (int nu = 39850; nu >= 350; nu -= 100) old += strf("%d %g\n", nu, c == 0 ? 0.9 : 0.25);
  }
  write_file(folder_ / "old.ems", old);
  EXPECT_NEAR(read_curve(folder_ / "old.ems", {}).at(10.0), 0.1, 1e-12);
  EXPECT_NEAR(read_curve(folder_ / "old.ems", options).at(0.3), 0.75, 1e-12);
  write_file(folder_ / "cut.ems", old.substr(0, old.size() / 2));
  EXPECT_THAT(message_of([&] { read_curve(folder_ / "cut.ems", {}); }), HasSubstr("cut.ems:"));
}

// Reads `text` as a curve whose items are files of the folder.
Curve joined(const std::string& folder, const std::string& text) {
  const Params p = Params::parse_text("c: " + text, "s.yaml").at("c");
  return read_joined(p, [&](const Params& one) {
    CurveOptions options;
    if (one.kind() != Params::Kind::map) return read_curve(folder + "/" + one.as_text(), options);
    if (one.has("constant")) return Curve::constant(one.number("constant"));
    options.outside = read_outside(one);
    return read_curve(folder + "/" + one.text("file"), options);
  });
}

class JoinedCurves : public CurveFile {
 protected:
  JoinedCurves() {
    write_file(folder_ / "low.txt", "0.4 1\n0.6 1\n0.8 1\n1.0 1\n1.2 1\n");
    write_file(folder_ / "high.txt", "0.9 3\n1.1 3\n1.3 3\n2.0 3\n");
    write_file(folder_ / "near.txt", "1.5 5\n1.9 5\n");  // 0.3 from low, whose rows are 0.2 apart
    write_file(folder_ / "far.txt", "2.5 5\n2.6 5\n");
    write_file(folder_ / "inside.txt", "0.5 5\n0.7 5\n");
  }
  Curve of(const std::string& text) { return joined(folder_.path(), text); }
  std::string fault(const std::string& text) {
    return message_of([&] { of(text); });
  }
};

TEST_F(JoinedCurves, MeetInTheMiddleOfWhatTheyShare) {
  const Curve c = of("[low.txt, high.txt]");  // they share 0.9 to 1.2
  EXPECT_EQ(c.wavelength_um(), (std::vector<double>{0.4, 0.6, 0.8, 1.0, 1.1, 1.3, 2.0}));
  EXPECT_EQ(c.value(), (std::vector<double>{1, 1, 1, 1, 3, 3, 3}));
  EXPECT_EQ(c.outside(), Outside::error);
}

TEST_F(JoinedCurves, MeetWhereTheyAreTold) {
  const Curve c = of("{join: [low.txt, high.txt], at_um: [1.15], outside: hold}");
  EXPECT_EQ(c.wavelength_um(), (std::vector<double>{0.4, 0.6, 0.8, 1.0, 1.3, 2.0}));
  EXPECT_EQ(c.outside(), Outside::hold);
}

TEST_F(JoinedCurves, BridgeAGapNoWiderThanTwoSteps) {
  const Curve c = of("[low.txt, near.txt]");
  EXPECT_DOUBLE_EQ(c.at(1.35), 3);  // half way from 1 to 5
}

TEST_F(JoinedCurves, AreRefusedWithTheirPlace) {
  EXPECT_THAT(fault("[low.txt, far.txt]"), HasSubstr("no curve is given between 1.2 and 2.5 um"));
  EXPECT_THAT(fault("[low.txt, far.txt]"), HasSubstr("s.yaml:1:14"));
  EXPECT_THAT(fault("[high.txt, low.txt]"), HasSubstr("list curves from short to long wavelengths"));
  EXPECT_THAT(fault("[low.txt, inside.txt]"), HasSubstr("none inside another"));
  EXPECT_THAT(fault("[low.txt]"), HasSubstr("two curves at least"));
  EXPECT_THAT(fault("[low.txt, [high.txt, far.txt]]"), HasSubstr("a list inside a list"));
  EXPECT_THAT(fault("[{constant: 1}, high.txt]"), HasSubstr("a constant has no wavelengths"));
  EXPECT_THAT(fault("[{file: low.txt, outside: hold}, high.txt]"), HasSubstr("write 'outside' beside 'join'"));
  EXPECT_THAT(fault("{join: [low.txt, high.txt], at_um: [0.5]}"), HasSubstr("they meet from 0.9 to 1.2 um"));
  EXPECT_THAT(fault("{join: [low.txt, high.txt], at_um: [1, 1.1]}"), HasSubstr("2 wavelengths for 2 curves"));
}

// A file as the ECOSTRESS library has them: percent, descending or not, over `count` wavelengths from low to high.
std::string library_file(double low, double high, int count, bool descending, double (*percent)(double)) {
  std::string text = strf(
      "Name: a grass\nType: vegetation\nClass: grass\nWavelength Range: VSWIR\nMeasurement: Bidirectional "
      "reflectance\nFirst Column: X\nSecond Column: Y\nX Units: Wavelength (micrometer)\nY Units: Reflectance "
      "(percentage)\nFirst X Value: %g\nLast X Value: %g\nNumber of X Values: %d\nAdditional Information: \n\n",
      descending ? high : low, descending ? low : high, count);
  for (int k = 0; k < count; ++k) {
    const double um = low + (high - low) * (descending ? count - 1 - k : k) / (count - 1);
    text += strf(" %.4f\t %.4f\r\n", um, percent(um));
  }
  return text;
}

// Two instruments of one sample meet where the first one ends; the second is written from long to short wavelengths.
TEST_F(CurveFile, LibrarySpectraOfTwoInstruments) {
  write_file(folder_ / "vswir.spectrum.txt",
             library_file(0.35, 2.5, 2151, false, [](double um) { return 10 + 20 * um; }));
  write_file(folder_ / "tir.spectrum.txt", library_file(2.5, 15.5, 1301, true, [](double um) { return 20 - um; }));
  const Curve one = read_curve(folder_ / "vswir.spectrum.txt", {});
  EXPECT_DOUBLE_EQ(one.low_um(), 0.35);
  EXPECT_DOUBLE_EQ(one.high_um(), 2.5);
  EXPECT_NEAR(one.at(0.351), 0.1702, 1e-9);
  const Curve both = joined(folder_.path(), "[vswir.spectrum.txt, tir.spectrum.txt]");
  EXPECT_DOUBLE_EQ(both.low_um(), 0.35);
  EXPECT_DOUBLE_EQ(both.high_um(), 15.5);
  EXPECT_NEAR(both.at(2.499), 0.5998, 1e-9);
  EXPECT_NEAR(both.at(2.51), 0.1749, 1e-9);
}

}  // namespace
}  // namespace suite::format_curve_read_test
