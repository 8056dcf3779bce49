// FourCurve atmospheres as documented, written here, and their faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "base/files.h"
#include "formats/four_curve/four_curve.h"
#include "formats/hdf5/h5.h"
#include "math/vec.h"
#include "tests/support/message_of.h"
#include "tests/support/temp_folder.h"

namespace suite::format_four_curve_read_test {
namespace {

using testing::HasSubstr;

struct Parts {
  std::vector<float> wavelengths = {0.4f, 0.5f, 0.6f}, angles = {10, 70};
  std::vector<float> values = {0.1f,  0.11f, 0.12f, 1e-9f, 2e-9f, 3e-9f, 1e-4f, 2e-4f, 0, 0.02f, 0.02f, 0.02f,
                               0.03f, 0.04f, 0.05f, 4e-9f, 5e-9f, 6e-9f, 1e-4f, 2e-4f, 0, 0.01f, 0.01f, 0.01f};
  size_t width = 3;
};

std::string written(const Parts& parts, const TempFolder& folder) {
  const std::string path = folder.path() + "/curves.hdf";
  h5::Writer writer(path, path);
  writer.put("/SpectralSamples", parts.wavelengths, "1", std::max<size_t>(parts.wavelengths.size(), 1));
  writer.put("/SolarDeclinationSamples", parts.angles, "1");
  writer.put("/Conditions/clear", parts.values, "1", parts.width);
  writer.close();
  return path;
}

TEST(FourCurve, SpectraAndUnits) {
  const TempFolder folder;
  const std::vector<FourCurve> all = read_four_curve(written({}, folder));
  ASSERT_EQ(all.size(), 1u);
  const FourCurve& c = all[0];
  EXPECT_EQ(c.name, "clear");
  EXPECT_NEAR(c.wavelength_um[2], 0.6, 1e-7);
  EXPECT_NEAR(c.solar_zenith[1], 70 * kDegree, 1e-7);
  EXPECT_NEAR(c.at[0].sun[2], 1200, 1e-3);
  EXPECT_NEAR(c.at[1].path_radiance[0], 4e-5, 1e-11);
  EXPECT_NEAR(c.at[0].extinction[1], 2e-4, 1e-10);
  EXPECT_NEAR(c.at[1].sky[0], 100, 1e-4);
}

TEST(FourCurve, PathsOfHomogeneousAir) {
  const TempFolder folder;
  const PathTable table = four_curve_paths(read_four_curve(written({}, folder))[0], 20e3);
  PathSpectra path;
  table.at(std::array{10 * kDegree, 5e3}, path);
  EXPECT_NEAR(path.transmittance[1], std::exp(-1.0), 1e-7);
  EXPECT_NEAR(path.radiance[1], 2e-5 / 2e-4 * (1 - std::exp(-1.0)), 1e-7);
  EXPECT_NEAR(path.radiance[2], 3e-5 * 5e3, 1e-6);  // without extinction
  EXPECT_NEAR(path.irradiance[0], 1000, 1e-3);
  EXPECT_THAT(message_of([&] { table.at(std::array{10 * kDegree, 21e3}, path); }), HasSubstr("covers 0 to 20000 m"));
  EXPECT_THAT(message_of([&] { table.at(std::array{80 * kDegree, 1e3}, path); }), HasSubstr("solar zenith angle 80"));
}

TEST(FourCurve, Faults) {
  const TempFolder folder;
  const auto told = [&](const Parts& parts) {
    const std::string path = written(parts, folder);
    return message_of([&] { read_four_curve(path); });
  };
  Parts bad;
  bad.angles = {70, 10};
  EXPECT_THAT(told(bad), HasSubstr("'/SolarDeclinationSamples' does not ascend: 70, then 10"));
  bad.angles = {10, 190};
  EXPECT_THAT(told(bad), HasSubstr("holds 190"));
  bad.angles = {10, 20, 30};
  EXPECT_THAT(told(bad), HasSubstr("'/Conditions/clear' has 8 x 3 values, 12 x 3 are wanted"));
  bad = {};
  bad.values[4] = -1;
  EXPECT_THAT(told(bad), HasSubstr("holds -1, which is no spectrum"));
  bad.values[4] = NAN;
  EXPECT_THAT(told(bad), HasSubstr("nan"));
  const std::string path = folder.path() + "/curves.hdf";
  AtomicFile text(path);
  text.write("no HDF5");
  text.commit();
  EXPECT_THAT(message_of([&] { read_four_curve(path); }), HasSubstr("curves.hdf: error: is not an HDF5 file"));
  EXPECT_THAT(message_of([&] { read_four_curve(folder.path() + "/none.hdf"); }), HasSubstr("none.hdf"));
}

}  // namespace
}  // namespace suite::format_four_curve_read_test
