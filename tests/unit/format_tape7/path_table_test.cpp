// Runs of files put together to a table of paths.
#include "formats/tape7/path_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "base/files.h"
#include "math/vec.h"
#include "tests/support/message_of.h"

namespace suite::format_tape7_path_table_test {
namespace {

using testing::HasSubstr;

const std::string kFolder = SUITE_TEST_DATA "/modtran/";

// The run of a file with another zenith angle and its columns dimmed.
Tape7Block changed(double zenith_deg, double range) {
  Tape7Block run = read_tape7(kFolder + "path1000.tape7")[0];
  run.geometry->zenith = zenith_deg * kDegree;
  run.geometry->range = range;
  for (Tape7Column& c : run.columns)
    if (c.name == "TOT_TRANS")
      for (double& v : c.values) v = std::pow(v, range / 1000);
  return run;
}

TEST(Tape7PathTable, RunsOverAngleAndRange) {
  const std::array axes{Tape7Axis::view_zenith, Tape7Axis::range};
  const std::vector<Tape7Block> runs = {changed(80, 1000), changed(89, 3000), changed(80, 3000), changed(89, 1000)};
  const PathTable table = tape7_path_table(runs, axes);
  EXPECT_EQ(table.wavelength_um().front(), 1e4 / 14000);
  PathSpectra path;
  table.at(std::array{89 * kDegree, 1000.0}, path);
  const Tape7Block& run = runs[3];
  // The last row of the file, 14000 1/cm, comes first.
  EXPECT_NEAR(path.transmittance[0], 0.87279296, 1e-9);
  EXPECT_NEAR(path.radiance[0], 3.0248e-8 * 1.96e8, 1e-9);
  EXPECT_NEAR(path.two_way[0], 4.61 / 7.3869, 1e-9);
  EXPECT_NEAR(path.irradiance[0], 5.26e-6 * 1.96e8, 1e-9);
  EXPECT_NEAR(path.transmittance.back(), run.transmittance().values[0], 1e-9);
  table.at(std::array{85 * kDegree, 2000.0}, path);
  EXPECT_NEAR(path.transmittance[0], std::pow(0.87279296, 2), 1e-9);
  EXPECT_THAT(message_of([&] {
                table.at(std::array{70 * kDegree, 2000.0}, path);
              }),
              HasSubstr("view zenith angle 70 degrees; it covers 80 to 89 degrees"));
  EXPECT_THAT(message_of([&] { table.at(std::array{85 * kDegree, 4e3}, path); }), HasSubstr("it covers 0 to 3000 m"));
}

TEST(Tape7PathTable, Faults) {
  const std::array angle{Tape7Axis::view_zenith}, range{Tape7Axis::range}, sun{Tape7Axis::solar_zenith};
  const auto told = [](std::vector<Tape7Block> runs, std::span<const Tape7Axis> axes) {
    return message_of([&] { tape7_path_table(runs, axes); });
  };
  EXPECT_EQ(told({changed(80, 1000)}, range), "no error");
  EXPECT_THAT(told({changed(80, 1000), changed(89, 3000)}, range),
              HasSubstr("path1000.tape7:11:5: error: the view zenith angle of this run differs"));
  EXPECT_THAT(told({changed(80, 1000)}, sun), HasSubstr("do not state its solar zenith angle"));
  EXPECT_THAT(told({changed(80, 1000), read_tape7(kFolder + "tape7-03")[0]}, range), HasSubstr("other wavenumbers"));
  Tape7Block no_cards = changed(80, 1000);
  no_cards.geometry.reset();
  EXPECT_THAT(told({no_cards}, angle), HasSubstr("do not state its geometry"));
  Tape7Block blank = changed(80, 1000);
  blank.columns[4].values[7] = NAN;  // SOL_SCAT
  EXPECT_THAT(told({blank}, angle), HasSubstr("path1000.tape7:19: error: column 'SOL_SCAT' is blank at 12007"));
}

}  // namespace
}  // namespace suite::format_tape7_path_table_test
