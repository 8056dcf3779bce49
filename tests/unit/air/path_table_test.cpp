// Tables of paths: right for homogeneous air at every range, never beyond what is covered, and their faults.
#include "air/path_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "math/vec.h"
#include "tests/support/message_of.h"

namespace suite::path_table_test {
namespace {

using testing::HasSubstr;

const std::vector<double> kWavelengths = {0.5, 0.6, 4.0, 10.0};
const std::vector<double> kExtinction = {1e-6, 2e-4, 5e-3, 4e-2};  // 1/m
constexpr double kSource[] = {3, 2, 1, 10};

PathRun homogeneous(double range) {
  PathRun run{{range}, {}, {strf("run of %g m", range), 0, 0, {}, -1}};
  for (size_t i = 0; i < 4; ++i) {
    run.spectra.transmittance.push_back(std::exp(-kExtinction[i] * range));
    run.spectra.radiance.push_back(kSource[i] * -std::expm1(-kExtinction[i] * range));
    run.spectra.two_way.push_back(std::exp(-2 * kExtinction[i] * range));
  }
  return run;
}

const PathAxis kRange{"range", "m", 1, "", true};

TEST(PathTable, HomogeneousAirIsRightAtEveryRange) {
  const PathTable table({kRange}, kWavelengths, {homogeneous(3000), homogeneous(500), homogeneous(1000)});
  PathSpectra path;
  for (const double range : {0.0, 1e-3, 1.0, 250.0, 500.0, 600.0, 999.0, 2500.0, 3000.0}) {
    table.at(std::array{range}, path);
    for (size_t i = 0; i < 4; ++i) {
      const double depth = kExtinction[i] * range;
      EXPECT_NEAR(path.transmittance[i], std::exp(-depth), 1e-12) << range;
      EXPECT_NEAR(path.radiance[i], kSource[i] * -std::expm1(-depth), 1e-12 * kSource[i]) << range;
      if (range < 500) continue;
      EXPECT_NEAR(path.two_way[i] / std::exp(-2 * depth), 1, 1e-9);
    }
    EXPECT_EQ(path.two_way.empty(), range < 500);
    EXPECT_TRUE(path.irradiance.empty());
  }
}

TEST(PathTable, NothingIsExtrapolated) {
  const PathTable table({kRange}, kWavelengths, {homogeneous(500), homogeneous(1000)});
  PathSpectra path;
  EXPECT_THAT(message_of([&] { table.at(std::array{1001.0}, path); }),
              HasSubstr("the path table does not reach to range 1001 m; it covers 0 to 1000 m"));
  EXPECT_THAT(message_of([&] { table.at(std::array{-1.0}, path); }), HasSubstr("range -1 m"));
  EXPECT_THAT(message_of([&] { table.at(std::array{std::nan("")}, path); }), HasSubstr("does not reach"));
  EXPECT_EQ(message_of([&] { table.at(std::array{1000.0004}, path); }), "no error");  // digits of a file
  const std::pair<double, double> bands[] = {{0.5, 0.55}, {0.4, 0.5}};
  EXPECT_THAT(message_of([&] { table.averaged(bands); }),
              HasSubstr("does not cover 0.4 to 0.5 um; it covers 0.5 to 10 um"));
}

// A sky over zenith and azimuth: bilinear, and exact at its runs.
TEST(PathTable, SkyOverTwoAngles) {
  std::vector<PathRun> runs;
  for (const double zenith : {0.0, 30.0, 60.0})
    for (const double azimuth : {180.0, 0.0, 90.0})
      runs.push_back({{zenith * kDegree, azimuth * kDegree}, {{}, {zenith + azimuth / 10, 1}, {}, {}}, {}});
  const PathTable sky({{"view zenith angle", "rad", 1 / kDegree, "degrees", false},
                       {"relative azimuth", "rad", 1 / kDegree, "degrees", false}},
                      {1, 2}, runs);
  PathSpectra path;
  for (const double zenith : {0.0, 12.0, 30.0, 59.0, 60.0})
    for (const double azimuth : {0.0, 45.0, 90.0, 170.0}) {
      sky.at(std::array{zenith * kDegree, azimuth * kDegree}, path);
      EXPECT_NEAR(path.radiance[0], zenith + azimuth / 10, 1e-9);
      EXPECT_NEAR(path.radiance[1], 1, 1e-12);
      EXPECT_TRUE(path.transmittance.empty());
    }
  EXPECT_THAT(message_of([&] {
                sky.at(std::array{70 * kDegree, 0.0}, path);
              }),
              HasSubstr("view zenith angle 70 degrees; it covers 0 to 60 degrees"));
  runs.pop_back();
  EXPECT_THAT(message_of([&] {
                PathTable({sky.axes()[0], sky.axes()[1]}, {1, 2}, runs);
              }),
              HasSubstr("no run at view zenith angle 60 degrees, relative azimuth 90 degrees"));
}

TEST(PathTable, Averages) {
  PathRun run{{0}, {{0.2, 0.6, 1.0}, {}, {}, {10, 20, 30}}, {}};
  const PathTable table({{"x", "m", 1, "", false}}, {1, 2, 3}, {run});
  const std::pair<double, double> bands[] = {{1, 2}, {1.5, 2.5}};
  PathSpectra path;
  table.averaged(bands).at(std::array{0.0}, path);
  EXPECT_NEAR(path.transmittance[0], 0.4, 1e-12);
  EXPECT_NEAR(path.transmittance[1], 0.6, 1e-12);
  EXPECT_NEAR(path.irradiance[1], 20, 1e-12);
}

TEST(PathTable, Faults) {
  const auto told = [](std::vector<PathRun> runs, std::vector<double> wavelengths = kWavelengths) {
    return message_of([&] { PathTable({kRange}, wavelengths, runs); });
  };
  EXPECT_THAT(told({}), HasSubstr("without a run"));
  EXPECT_THAT(told({homogeneous(5), homogeneous(5)}),
              HasSubstr("run of 5 m: error: two runs at range 5 m; the other one: run of 5 m"));
  EXPECT_THAT(told({homogeneous(5)}, {1, 2}), HasSubstr("4 values of transmittance for 2 wavelengths"));
  EXPECT_THAT(told({homogeneous(5)}, {1, 3, 2, 4}), HasSubstr("do not ascend at 2 um"));
  EXPECT_THAT(told({homogeneous(0)}), HasSubstr("begins at a range of 0 m"));
  PathRun bad = homogeneous(5);
  bad.spectra.transmittance[2] = 1.5;
  EXPECT_THAT(told({bad}), HasSubstr("run of 5 m: error: the transmittance at 4 um is 1.5 at range 5 m; 0 to 1"));
  bad = homogeneous(5);
  bad.spectra.radiance[1] = NAN;
  EXPECT_THAT(told({bad}), HasSubstr("path radiance at 0.6 um is nan"));
  bad.spectra.radiance.clear();
  EXPECT_THAT(told({homogeneous(9), bad}), HasSubstr("only one has path radiance"));
}

}  // namespace
}  // namespace suite::path_table_test
