// The scene frame against published worked examples and against itself.
#include "motion/scene_frame.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "math/sampling.h"

namespace suite::scene_frame_test {
namespace {

double dms(double d, double m, double s) { return d + m / 60 + s / 3600; }

// IOGP Geomatics Guidance Note 7-2, section on geographic/geocentric and geocentric/topocentric conversions.
const Geodetic kPlace{dms(53, 48, 33.820), dms(2, 7, 46.380), 73.0};

TEST(SceneFrame, GeocentricExampleOfGuidanceNote) {
  const Vec3 p = ecef_from_geodetic(kPlace);
  EXPECT_NEAR(p.x, 3771793.968, 6e-4);
  EXPECT_NEAR(p.y, 140253.342, 6e-4);
  EXPECT_NEAR(p.z, 5124304.349, 6e-4);
}

TEST(SceneFrame, TopocentricExampleOfGuidanceNote) {
  const SceneFrame frame({55, 5, 200});
  const Vec3 p = frame.enu_from_geodetic(kPlace);
  EXPECT_NEAR(p.x, -189013.869, 6e-4);
  EXPECT_NEAR(p.y, -128642.040, 6e-4);
  EXPECT_NEAR(p.z, -4220.171, 6e-4);
}

// The example of GeographicLib's GeoConvert manual: 33.3 N 44.4 E is 38n 444140.54 3684706.36.
TEST(SceneFrame, UtmExample) {
  const UtmPoint u = utm_from_geodetic({33.3, 44.4, 12}, standard_utm_zone({33.3, 44.4, 0}));
  EXPECT_EQ(u.grid, (UtmZone{38, true}));
  EXPECT_NEAR(u.easting, 444140.54, 5.1e-3);
  EXPECT_NEAR(u.northing, 3684706.36, 5.1e-3);
  EXPECT_EQ(u.height_m, 12);
}

TEST(SceneFrame, StandardZoneKnowsNorwayAndSvalbard) {
  EXPECT_EQ(standard_utm_zone({60, 4, 0}).zone, 32);
  EXPECT_EQ(standard_utm_zone({78, 10, 0}).zone, 33);
  EXPECT_EQ(standard_utm_zone({-33, 151, 0}), (UtmZone{56, false}));
  EXPECT_THROW(standard_utm_zone({85, 0, 0}), Error);
}

TEST(SceneFrame, RoundTripsToANanodegree) {
  Pcg32 rng(1);
  const SceneFrame frame({-34.7, 138.6, 50});
  double worst_deg = 0, worst_m = 0;
  for (int i = 0; i < 20000; ++i) {
    Geodetic g{-89.9 + 179.8 * rng.uniform(), -180 + 360 * rng.uniform(), -100 + 7e5 * rng.uniform()};
    const Geodetic b = frame.geodetic_from_enu(frame.enu_from_geodetic(g));
    const Geodetic u =
        geodetic_from_utm(utm_from_geodetic(g, {1 + static_cast<int>((g.longitude_deg + 180) / 6), i % 2 == 0}));
    for (const Geodetic& r : {b, u}) {
      worst_deg = std::fmax(worst_deg, std::fabs(r.latitude_deg - g.latitude_deg));
      worst_deg = std::fmax(worst_deg, std::fabs(std::remainder(r.longitude_deg - g.longitude_deg, 360.0)));
      worst_m = std::fmax(worst_m, std::fabs(r.height_m - g.height_m));
    }
  }
  RecordProperty("worst_deg", std::to_string(worst_deg * 1e12) + "e-12");
  EXPECT_LT(worst_deg, 1e-9);
  EXPECT_LT(worst_m, 1e-7);
}

TEST(SceneFrame, DirectionsAndPoseAgreeWithPoints) {
  const SceneFrame frame({48.5, 9.1, 450});
  const Vec3 p{1234.5, -987.6, 55.5}, d{0.6, -0.64, 0.48};
  EXPECT_LT(length(frame.to_ecef().point(p) - frame.ecef_from_enu(p)), 5e-9);
  EXPECT_LT(length(frame.ecef_from_enu(p + d) - frame.ecef_from_enu(p) - frame.ecef_direction(d)), 5e-9);
  EXPECT_LT(length(frame.enu_direction(frame.ecef_direction(d)) - d), 1e-15);
  const Frame here = frame.local_axes({0, 0, 0});
  EXPECT_LT(length(here.x - Vec3{1, 0, 0}) + length(here.y - Vec3{0, 1, 0}) + length(here.z - Vec3{0, 0, 1}), 1e-8);
}

TEST(SceneFrame, UpTiltsByTheDistanceOverTheRadius) {
  const SceneFrame frame({0, 0, 0});
  const double r = 10000, normal_radius = 6378137.0;  // along the equator
  const Frame there = frame.local_axes({r, 0, 0});
  EXPECT_NEAR(std::atan2(there.z.x, there.z.z), std::atan2(r, normal_radius), 1e-9);
}

TEST(SceneFrame, CurvedPlaneKeepsDistanceHeightAndAzimuth) {
  const SceneFrame frame({40, -105, 1600});
  const Vec3 plane{30000, 40000, 25};
  const Vec3 p = frame.curved(plane);
  EXPECT_NEAR(frame.geodetic_from_enu(p).height_m, 1625, 1e-6);
  EXPECT_NEAR(p.z - 25, -5e4 * 5e4 / (2 * 6.37e6), 1);  // drop r^2/(2R), about 196 m
  EXPECT_NEAR(std::atan2(p.y, p.x), std::atan2(40000, 30000), 1e-5);
  EXPECT_LT(length(frame.flattened(p) - plane), 1e-5);
  EXPECT_LT(length(frame.curved({0, 0, 0})), 1e-8);
}

// The rotation must be the derivative of the map: exact across the plane's radial direction and upwards, and along it
// up to the stretch of the map (h/R).
TEST(SceneFrame, CurvedRotationIsTheDerivativeOfTheMap) {
  const SceneFrame frame({60, 20, 0});
  const Vec3 plane{50000, 80000, 0};
  const Quat q = frame.curved_rotation(plane);
  const double step = 1;
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    const Vec3 moved = (frame.curved(plane + axis * step) - frame.curved(plane - axis * step)) / (2 * step);
    EXPECT_LT(length(rotate(q, axis) - moved), 1e-4) << axis.x << axis.y << axis.z;
  }
}

TEST(SceneFrame, EpsgCodes) {
  EXPECT_EQ(utm_zone_of_epsg(32633), (UtmZone{33, true}));
  EXPECT_EQ(utm_zone_of_epsg(32756), (UtmZone{56, false}));
  EXPECT_EQ(utm_zone_of_epsg(25832), (UtmZone{32, true}));
  for (const int code : {32600, 32661, 32700, 32761, 25827, 25839, 4326, 0})
    EXPECT_FALSE(utm_zone_of_epsg(code)) << code;
  EXPECT_EQ(utm_zone_of_text("33N"), (UtmZone{33, true}));
  EXPECT_EQ(utm_zone_of_text("7 south"), (UtmZone{7, false}));
  for (const char* text : {"", "61N", "0N", "33", "33X", "N", "333N"}) EXPECT_FALSE(utm_zone_of_text(text)) << text;
}

TEST(SceneFrame, RefusesWhatIsNoPlace) {
  EXPECT_THROW(SceneFrame({91, 0, 0}), Error);
  EXPECT_THROW(SceneFrame({0, 361, 0}), Error);
  EXPECT_THROW(SceneFrame({0, 0, NAN}), Error);
  EXPECT_THROW(ecef_from_geodetic({NAN, 0, 0}), Error);
  EXPECT_THROW(utm_from_geodetic({0, 0, 0}, {61, true}), Error);
  EXPECT_THROW(utm_from_geodetic({0, 90, 0}, {31, true}), Error);
  EXPECT_THROW(geodetic_from_utm({{31, true}, 1e9, 0, 0}), Error);
  EXPECT_THROW(geodetic_from_utm({{31, true}, 5e5, -2e7, 0}), Error);
  EXPECT_THROW(SceneFrame({0, 0, 0}).curved({6e6, 0, 0}), Error);
}

}  // namespace
}  // namespace suite::scene_frame_test
