// Rasters out: GDAL reads the metadata of the TIFF, viewers find a picture in the OpenEXR.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <thread>

#include "base/files.h"
#include "formats/raster/raster.h"
#include "formats/raster/raster_write.h"
#include "support/message_of.h"
#include "support/run_command.h"

namespace suite::format_raster_write_test {
namespace {

using testing::HasSubstr;
using testing::Not;

FloatRaster small() {
  FloatRaster r;
  r.width = 5, r.height = 3;
  r.bands = {{"blue & <deep>", 0.475, 0.03}, {"green", 0.56, 0.02}, {"red", 0.66, 0.02}, {"nir", 0.86, 0.04}};
  r.units = "W/(m2 sr um)";
  r.display = {2, 1, 0}, r.true_colour = true;
  r.no_data = NAN;
  r.utc = "2026-06-21T10:30:02.500000Z";
  r.sun_deg = {151.5, 61.75};
  r.comment = "who made it";
  return r;
}
std::vector<float> numbers(const FloatRaster& r) {
  std::vector<float> v(size_t{r.width} * r.height * r.bands.size());
  for (size_t i = 0; i < v.size(); ++i) v[i] = 0.25f * static_cast<float>(i);
  return v;
}

class RasterWrite : public testing::Test {
 protected:
  std::string info(const std::string& file) { return run_command("gdalinfo -mdd all '" + (folder_ / file) + "'").out; }
  static bool no_gdal() { return run_command("command -v gdalinfo").code != 0; }
  TempFolder folder_;
};

TEST_F(RasterWrite, NumbersComeBack) {
  FloatRaster r = small();
  const std::vector<float> v = numbers(r);
  write_float_tiff(folder_ / "a.tif", r, v);
  EXPECT_EQ(read_raster(folder_ / "a.tif").values, v);
  // More than one strip.
  r.width = 700, r.height = 500;
  const std::vector<float> many = numbers(r);
  write_float_tiff(folder_ / "b.tif", r, many);
  EXPECT_EQ(read_raster(folder_ / "b.tif").values, many);
  EXPECT_EQ(folder_.entries(), 2u);
}

// No matter where a disk is full, there is a whole file or none, and an Error. OpenEXR's lost its end and stayed.
TEST_F(RasterWrite, FullDisksLeaveNothing) {
  FloatRaster r = small();
  r.width = 61, r.height = 47;
  const std::vector<float> v = numbers(r);
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  for (const bool exr : {false, true}) {
    const std::string path = folder_ / (exr ? "a.exr" : "a.tif");
    const auto write = [&] { exr ? write_exr(path, r, v) : write_float_tiff(path, r, v); };
    write();
    const size_t size = file_size(path);
    std::filesystem::remove(path);
    for (const size_t limit : {size_t{0}, size_t{100}, size / 3, size - 3000, size - 700, size - 100, size - 1}) {
      struct rlimit tight = before;
      tight.rlim_cur = limit;
      ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
      const std::string said = message_of(write);
      ::setrlimit(RLIMIT_FSIZE, &before);
      EXPECT_THAT(said, HasSubstr("cannot be written")) << path << " " << limit << " of " << size;
      EXPECT_EQ(folder_.entries(), 0u) << path << " " << limit;
    }
  }
  ::signal(SIGXFSZ, handler);
}

TEST_F(RasterWrite, GdalReadsWhatIsTold) {
  if (no_gdal()) GTEST_SKIP() << "gdalinfo (Debian package gdal-bin) is not installed";
  const FloatRaster r = small();
  write_float_tiff(folder_ / "a.tif", r, numbers(r));
  const std::string text = info("a.tif");
  for (const char* part :
       {"ACQUISITIONDATETIME=2026-06-21 10:30:02\n", "acquisition_time=2026-06-21T10:30:02.500000Z", "who made it",
        "sun_elevation_deg=61.75",
        "ColorInterp=Blue\n  Description = blue & <deep>\n  NoData Value=nan\n  Unit Type: W/(m2 sr um)",
        "ColorInterp=Green\n  Description = green", "ColorInterp=Red\n  Description = red",
        "ColorInterp=Undefined\n  Description = nir", "CENTRAL_WAVELENGTH_UM=0.86\n    FWHM_UM=0.04"})
    EXPECT_THAT(text, HasSubstr(part));
}

// Bands that are no colours are not called so, whatever their order.
TEST_F(RasterWrite, FalseColoursAreNotCalledColours) {
  if (no_gdal()) GTEST_SKIP() << "gdalinfo (Debian package gdal-bin) is not installed";
  FloatRaster r = small();
  r.display = {3, 2, 1}, r.true_colour = false, r.no_data.reset(), r.utc.clear(), r.sun_deg.reset();
  write_float_tiff(folder_ / "a.tif", r, numbers(r));
  const std::string text = info("a.tif");
  for (const char* part : {"ColorInterp=Red", "ColorInterp=Green", "ColorInterp=Blue", "NoData", "ACQUISITION"})
    EXPECT_THAT(text, Not(HasSubstr(part)));
}

TEST_F(RasterWrite, AnExrBeginsWithThePicture) {
  const FloatRaster r = small();
  const std::vector<float> v = numbers(r);
  write_exr(folder_ / "a.exr", r, v);
  const Raster back = read_raster(folder_ / "a.exr");
  ASSERT_EQ(back.channels, 7u);
  for (size_t p = 0; p < 15; ++p)
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(back.values[7 * p + i], v[4 * p + r.display[i]]);
  FloatRaster plain = r;
  plain.display.clear();
  write_exr(folder_ / "b.exr", plain, v);
  EXPECT_EQ(read_raster(folder_ / "b.exr").channels, 4u);
}

// The same picture is the same file, whenever it is written.
TEST_F(RasterWrite, FilesDoNotKnowTheHour) {
  FloatRaster r = small();
  for (const std::string& utc : {std::string(), r.utc}) {
    r.utc = utc;
    for (const char* name : {"a", "b"}) {
      write_exr(folder_ / (std::string(name) + ".exr"), r, numbers(r));
      write_float_tiff(folder_ / (std::string(name) + ".tif"), r, numbers(r));
      std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    }
    EXPECT_EQ(read_bytes(folder_ / "a.exr"), read_bytes(folder_ / "b.exr"));
    EXPECT_EQ(read_bytes(folder_ / "a.tif"), read_bytes(folder_ / "b.tif"));
  }
}

}  // namespace
}  // namespace suite::format_raster_write_test
