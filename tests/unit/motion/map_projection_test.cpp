// Maps of any EPSG code through PROJ, against published figures, a closed form, and the program that comes with it.
#include "motion/map_projection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/error.h"
#include "math/vec.h"
#include "support/message_of.h"
#include "support/run_command.h"

namespace suite::map_projection_test {
namespace {

using testing::HasSubstr;

constexpr double kMillimetre = 1e-3 / 111e3;  // degrees of latitude

class MapProjections : public testing::Test {
 protected:
  void SetUp() override {
    const std::string fault = message_of([] { MapProjection(3857); });
    if (fault.find("PROJ is not there") == fault.npos) return;
    EXPECT_THAT(fault, HasSubstr("libproj25")) << "the package is named";
    GTEST_SKIP() << fault;
  }
};

// IOGP Publication 373-7-2, Geomatics Guidance Note 7 part 2, "Lambert Azimuthal Equal Area": ETRS89-LAEA Europe at 50
// N, 5 E, where it gives centimetres.
TEST_F(MapProjections, PublishedExampleOfEurope) {
  const MapProjection map(3035);
  EXPECT_FALSE(map.geographic());
  EXPECT_THAT(map.name(), HasSubstr("LAEA"));
  const Geodetic g = map.place(3962799.45, 2999718.85, 12);
  EXPECT_NEAR(g.latitude_deg, 50, 10 * kMillimetre);
  EXPECT_NEAR(g.longitude_deg, 5, 10 * kMillimetre / std::cos(50 * kDegree));
  EXPECT_EQ(g.height_m, 12);
}

// Pseudo-Mercator: x = a lambda, y = a ln tan(pi / 4 + phi / 2).
TEST_F(MapProjections, PseudoMercatorHasAClosedForm) {
  constexpr double a = 6378137;
  const double latitude = 47.123456, longitude = -12.3456;
  const Geodetic g =
      MapProjection(3857).place(a * longitude * kDegree, a * std::log(std::tan(kPi / 4 + latitude * kDegree / 2)), 0);
  EXPECT_NEAR(g.latitude_deg, latitude, kMillimetre / 100);
  EXPECT_NEAR(g.longitude_deg, longitude, kMillimetre / 100);
}

// Longitude comes first whatever EPSG's own order is, and NAD83 is WGS84 to some metres, which is told.
TEST_F(MapProjections, AnglesAreEastBeforeNorth) {
  const MapProjection map(4269);
  EXPECT_TRUE(map.geographic());
  const Geodetic g = map.place(-120.5, 38.25, 7);
  EXPECT_NEAR(g.latitude_deg, 38.25, 1e-4);
  EXPECT_NEAR(g.longitude_deg, -120.5, 1e-4);
  EXPECT_THAT(map.description(), testing::StartsWith("by PROJ"));
}

TEST_F(MapProjections, HeightsAreToldApart) {
  EXPECT_EQ(MapProjection(2154).heights(), MapSystem::Heights::unknown);
  const MapProjection dutch(7415);  // RD New + NAP
  EXPECT_EQ(dutch.heights(), MapSystem::Heights::geoid);
  EXPECT_EQ(dutch.heights_name(), "NAP height");
  EXPECT_EQ(MapProjection(4979).heights(), MapSystem::Heights::ellipsoid);
}

TEST_F(MapProjections, RefusesWhatIsNoMap) {
  EXPECT_THAT(message_of([] { MapProjection(999999); }), HasSubstr("PROJ does not know EPSG:999999"));
  EXPECT_THAT(message_of([] { MapProjection(5703); }), HasSubstr("neither projected nor geographic"));
  EXPECT_THAT(message_of([] { MapProjection(3035).place(1e12, 1e12, 0); }), HasSubstr("finds no place on the Earth"));
}

// Within a millimetre of what GDAL makes of the same places: metres, US survey feet, other datums.
TEST_F(MapProjections, AsGdalDoes) {
  if (run_command("command -v gdaltransform").code != 0)
    GTEST_SKIP() << "gdaltransform (Debian package gdal-bin) is not installed";
  const struct {
    int epsg;
    double x, y;
  } table[] = {{2154, 652709.4, 6862305.2}, {2263, 987000.0, 211000.0},   {26910, 551000.0, 4184000.0},
               {28992, 121000.0, 487000.0}, {3035, 4321000.0, 3210000.0}, {31256, 1500.0, 341000.0}};
  for (const auto& row : table) {
    const CommandResult r =
        run_command(strf("echo '%.9g %.9g' | gdaltransform -s_srs EPSG:%d -t_srs EPSG:4326", row.x, row.y, row.epsg));
    std::istringstream said(r.out);
    double longitude = 0, latitude = 0;
    ASSERT_TRUE(said >> longitude >> latitude) << r.out << r.err;
    const Geodetic g = MapProjection(row.epsg).place(row.x, row.y, 0);
    EXPECT_NEAR(g.latitude_deg, latitude, kMillimetre) << row.epsg;
    EXPECT_NEAR(g.longitude_deg, longitude, kMillimetre) << row.epsg;
  }
}

}  // namespace
}  // namespace suite::map_projection_test
