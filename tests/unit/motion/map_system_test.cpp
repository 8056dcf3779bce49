// Reference systems by their codes, and heights above a geoid whose grid is made here.
#include "motion/map_system.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::map_system_test {
namespace {

TEST(MapSystem, CodesOfNames) {
  EXPECT_EQ(epsg_of_name("EPSG:25832"), 25832);
  EXPECT_EQ(epsg_of_name("urn:ogc:def:crs:EPSG::7415"), 7415);
  EXPECT_EQ(epsg_of_name("urn:ogc:def:crs:EPSG:6.12:25833"), 25833);
  EXPECT_EQ(epsg_of_name("https://www.opengis.net/def/crs/EPSG/0/7415"), 7415);
  EXPECT_EQ(epsg_of_name("urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783"), 25832);
  EXPECT_EQ(epsg_of_name("EPSG:25832+7837"), 25832);
  EXPECT_EQ(epsg_of_name("https://www.opengis.net/def/crs-compound?1=https://www.opengis.net/def/crs/EPSG/0/25832&2="
                         "https://www.opengis.net/def/crs/EPSG/0/7837"),
            25832);
  EXPECT_EQ(epsg_of_name("urn:adv:crs:ETRS89_UTM33*DE_DHHN2016_NH"), 25833);
  EXPECT_EQ(epsg_of_name("urn:adv:crs:ETRS89_UTM99"), std::nullopt);
  EXPECT_EQ(epsg_of_name("urn:adv:crs:DE_DHDN_3GK3"), std::nullopt);
  EXPECT_EQ(epsg_of_name(""), std::nullopt);
  EXPECT_EQ(epsg_of_name("EPSG:99999999999999"), std::nullopt);
}

TEST(MapSystem, KnownCodes) {
  EXPECT_EQ(map_system_of_epsg(5555)->zone, (UtmZone{32, true}));
  EXPECT_EQ(map_system_of_epsg(5555)->heights, MapSystem::Heights::geoid);
  EXPECT_EQ(map_system_of_epsg(32719)->zone, (UtmZone{19, false}));
  EXPECT_EQ(map_system_of_epsg(4979)->zone, std::nullopt);
  EXPECT_FALSE(map_system_of_epsg(7415));
}

// Heights of lat/2 + 10 on a grid of 30 degrees, which a cubic keeps; 16 bits, most significant first.
std::string small_grid() {
  std::string text =
      "P5\n# Description made for a test\n# DateTime 2024-01-01 00:00:00\n# Offset -108\n# Scale 0.003\n# "
      "MaxBilinearError 1\n"
      "# RMSBilinearError 1\n# MaxCubicError 1\n# RMSCubicError 1\n12 7\n65535\n";
  for (int row = 0; row < 7; ++row)
    for (int column = 0; column < 12; ++column) {
      const double height = (90 - 30 * row) / 2.0 + 10;
      const auto raw = static_cast<unsigned>(std::lround((height + 108) / 0.003));
      text += static_cast<char>(raw >> 8);
      text += static_cast<char>(raw & 255);
    }
  return text;
}

TEST(GeoidGrid, HeightsAndPlaces) {
  const TempFolder folder;
  write_file(folder / "made.pgm", small_grid());
  const Geoid geoid(folder / "made.pgm");
  for (const double latitude : {-30.0, 0.0, 17.0, 45.0})
    for (const double longitude : {-170.0, 0.0, 11.0, 359.0})
      EXPECT_NEAR(geoid.height_m(latitude, longitude), latitude / 2 + 10, 0.004);
  const SceneFrame frame({45, 9, 100});
  const UtmPoint there = utm_from_geodetic({45, 9, 0}, {32, true});
  const MapSystem system = *map_system_of_epsg(5555);
  EXPECT_NEAR(enu_of_map(system, frame, 0)({there.easting, there.northing, 100}).z, 0, 1e-9);
  EXPECT_NEAR(enu_of_map(system, frame, 48)({there.easting, there.northing, 100}).z, 48, 1e-9);
  EXPECT_NEAR(enu_of_map(system, frame, 0, geoid)({there.easting, there.northing, 100}).z, 32.5, 0.004);
}

TEST(GeoidGrid, FaultsSayWhereGridsAreHad) {
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { Geoid(folder / "egm96-5.pgm"); }),
              testing::HasSubstr("egm96-5.pgm (19 MB) and others are had from"));
  write_file(folder / "short.pgm", small_grid().substr(0, 200));
  EXPECT_THAT(message_of([&] { Geoid(folder / "short.pgm"); }), testing::HasSubstr("cannot be read as a grid"));
}

}  // namespace
}  // namespace suite::map_system_test
