#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/curve/curve.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite {
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

TEST_F(CurveFile, LocalDirsigFiles) {
  const std::string folder = SUITE_LOCAL_DATA "/dirsig/";
  if (!file_exists(folder + "background_1.ems")) GTEST_SKIP() << "needs the local DIRSIG files";
  CurveOptions options;
  options.outside = Outside::hold;
  EXPECT_NEAR(read_curve(folder + "background_1.ems", options).at(0.35), 0.02, 1e-9);
  EXPECT_NEAR(read_curve(folder + "ideal_mat_1.ems", options).at(0.35), 0, 1e-9);
}

TEST_F(CurveFile, LocalEcostressLibrary) {
  const std::string grass = SUITE_LOCAL_DATA "/spectra/vegetation.grass.avena.fatua.vswir.vh352.ucsb.asd.spectrum.txt";
  if (!file_exists(grass)) GTEST_SKIP() << "needs the local library spectra";
  const Curve c = read_curve(grass, {});
  EXPECT_DOUBLE_EQ(c.low_um(), 0.35);
  EXPECT_DOUBLE_EQ(c.high_um(), 2.5);
  EXPECT_NEAR(c.at(0.351), 0.05923, 1e-9);
}

}  // namespace
}  // namespace suite
