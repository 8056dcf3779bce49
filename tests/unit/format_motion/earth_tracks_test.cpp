// Tracks over the Earth from CZML and from STK's ephemerides: places at samples and between them, when things are
// there, how they are turned, faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "formats/motion/track_files.h"
#include "motion/track_record.h"
#include "support/message_of.h"

namespace suite::format_motion_earth_tracks_test {
namespace {

using testing::HasSubstr;

const SceneFrame kFrame({48, 9, 500});
const MotionContext kContext{kFrame, Clock({2026, 6, 21, 10, 0, 0}), 0, nullptr};

std::vector<MovingThing> read(const std::string& text, const MotionContext& context = kContext) {
  const TrackFileRow* row = track_file_of(text);
  if (!row) throw Error("nobody knows it");
  return row->make(text, "folder/f.e", {context});
}

// A circle about the Earth's axis, as a satellite has it: m, at a time in s.
constexpr double kRadius = 7e6, kRate = 1e-3;
Vec3 circle(double t) { return {kRadius * std::cos(kRate * t), kRadius * std::sin(kRate * t), 1e6}; }
std::string points(int n, double step, const char* separator, const char* end) {
  std::string text;
  for (int i = 0; i < n; ++i) {
    const Vec3 p = circle(i * step);
    text += strf("%.17g%s%.17g%s%.17g%s%.17g%s", i * step, separator, p.x, separator, p.y, separator, p.z,
                 i + 1 < n ? end : "");
  }
  return text;
}
std::string stk(const std::string& keys, int n = 11) {
  return "stk.v.11.0\n# made by a test\nBEGIN Ephemeris\nScenarioEpoch 21 Jun 2026 10:01:00.000\nCentralBody Earth\n" +
         keys + "\nEphemerisTimePos\n\n" + points(n, 60, " ", "\n") + "\nEND Ephemeris\n";
}
std::string czml(const std::string& packet) {
  return "[{\"id\": \"document\", \"version\": \"1.0\"}, {\"id\": \"a\", " + packet + "}]";
}
std::string position(const std::string& more) {
  return "\"position\": {\"epoch\": \"2026-06-21T10:01:00Z\", " + more + "\"cartesian\": [" +
         points(11, 60, ", ", ", ") + "]}";
}

// The largest distance from the circle within a span of the file's seconds, which begin at the scene's 60.
double off_circle(const Track& track, double begin, double end) {
  double most = 0;
  for (int k = 0; k <= 500; ++k) {
    const double t = begin + (end - begin) * k / 500;
    most = std::max(most, length(track.at(60 + t).translation - kFrame.enu_from_ecef(circle(t))));
  }
  return most;
}

// The error of Lagrange's polynomial of degree n in the middle of equal steps h: r (w h)^(n+1) times the product of the
// distances to the nodes over (n + 1)!; at the ends of the table that is larger.
TEST(EarthTracks, PlacesAreInterpolated) {
  const auto linear = read(czml(position("")));
  ASSERT_EQ(linear.size(), 1u);
  const double sagitta = kRadius * kRate * kRate * 60 * 60 / 8;
  EXPECT_NEAR(off_circle(*linear[0].track, 0, 600), sagitta, 0.02 * sagitta);
  for (const auto& things :
       {read(czml(position("\"interpolationAlgorithm\": \"LAGRANGE\", \"interpolationDegree\": 5, "))),
        read(stk("CoordinateSystem Fixed\nInterpolationMethod Lagrange\nInterpolationOrder 5\nNumberOfEphemerisPoints "
                 "11"))}) {
    ASSERT_EQ(things.size(), 1u);
    const Track& track = *things[0].track;
    EXPECT_EQ(track.covered().begin, 60);
    EXPECT_EQ(track.covered().end, 660);
    // (5/2 3/2 1/2)^2 / 6! = 0.00488 in the middle.
    const double bound = kRadius * std::pow(60 * kRate, 6) * 0.00488;
    EXPECT_LT(off_circle(track, 120, 480), 1.02 * bound);
    EXPECT_GT(off_circle(track, 120, 480), 0.9 * bound);
    EXPECT_LT(off_circle(track, 0, 600), 6 * bound);
    // Without an orientation the body's y points north and its z up.
    const Geodetic place = kFrame.geodetic_from_enu(track.at(300).translation);
    EXPECT_NEAR(length(track.at(300).vector({0, 0, 1}) - rotate(geodetic_axes(kFrame, place), {0, 0, 1})), 0, 1e-6);
    // The same track from its record, to the last bit.
    const TrackPtr again = track_of(track.record());
    EXPECT_EQ(length(again->at(333.3).translation - track.at(333.3).translation), 0);
  }
  EXPECT_EQ(read(stk("CoordinateSystem Fixed"))[0].id, "f");
}

TEST(EarthTracks, GeodeticPlacesAndUnits) {
  const Geodetic where{48.01, 9.02, 700};
  const Vec3 enu = kFrame.enu_from_geodetic(where);
  for (const auto& text :
       {czml("\"position\": {\"cartographicDegrees\": [9.02, 48.01, 700]}"),
        czml(strf("\"position\": {\"cartographicRadians\": [%.17g, %.17g, 700]}", 9.02 * kDegree, 48.01 * kDegree)),
        czml("\"position\": {\"cartographicDegrees\": [\"2026-06-21T10:00:00Z\", 9.02, 48.01, 700, "
             "\"2026-06-21T10:00:09Z\", 9.02, 48.01, 700]}"),
        std::string("stk.v.9.0\nBEGIN Ephemeris\nScenarioEpoch 21 Jun 2026 10:00:00\nCoordinateSystem Fixed\n"
                    "DistanceUnit Kilometers\nEphemerisLLATimePosVel\n0 48.01 9.02 0.7 0 0 0\n9 48.01 9.02 0.7 0 0 0\n"
                    "END Ephemeris\n")})
    EXPECT_NEAR(length(read(text)[0].track->at(4).translation - enu), 0, 1e-5) << text;
}

TEST(EarthTracks, ThingsAreThereWhileTheyAreAvailable) {
  const auto things =
      read(czml("\"availability\": [\"2026-06-21T10:00:00Z/2026-06-21T10:02:30Z\", "
                "\"2026-06-21T10:05:00Z/2026-06-21T10:06:00Z\", "
                "\"2027-01-01T00:00:00Z/2027-01-02T00:00:00Z\"], " +
                position("\"interpolationAlgorithm\": \"LAGRANGE\", \"interpolationDegree\": 3, ")));
  const auto whole = read(czml(position("\"interpolationAlgorithm\": \"LAGRANGE\", \"interpolationDegree\": 3, ")));
  ASSERT_EQ(things.size(), 2u);
  EXPECT_EQ(things[0].track->covered().begin, 60);
  EXPECT_EQ(things[0].track->covered().end, 150);
  EXPECT_EQ(things[1].track->covered().begin, 300);
  EXPECT_EQ(things[1].track->covered().end, 360);
  // What it is interpolated from does not depend on when it is there.
  for (const double t : {300.0, 311.0, 333.0, 360.0})
    EXPECT_EQ(length(things[1].track->at(t).translation - whole[0].track->at(t).translation), 0) << t;
}

// A cubic of time, with its velocity: Hermite's cubic between two samples is it.
std::string cubic(const std::string& how) {
  std::string text;
  for (const double t : {0.0, 60.0, 200.0, 300.0})
    text += strf("%s%.17g, %.17g, %.17g, %.17g, 1, %.17g, %.17g", text.empty() ? "" : ", ", t, 7e6 + t, 10 * t * t,
                 0.01 * t * t * t, 20 * t, 0.03 * t * t);
  return "\"position\": {\"epoch\": \"2026-06-21T10:01:00Z\", \"interpolationAlgorithm\": \"" + how +
         "\", \"cartesianVelocity\": [" + text + "]}";
}

TEST(EarthTracks, VelocitiesCountWithHermite) {
  const auto off = [](const Track& track, double t) {
    return length(track.at(60 + t).translation - kFrame.enu_from_ecef({7e6 + t, 10 * t * t, 0.01 * t * t * t}));
  };
  for (const std::string degree :
       {"", "\", \"interpolationDegree\": 3, \"a\": \"", "\", \"interpolationDegree\": 7, \"a\": \""}) {
    const auto things = read(czml(cubic("HERMITE" + degree)));
    for (const double t : {0.0, 7.0, 60.0, 130.0, 222.0, 300.0})
      EXPECT_LT(off(*things[0].track, t), 1e-6) << t << degree;
    EXPECT_EQ(length(track_of(things[0].track->record())->at(190).translation - things[0].track->at(190).translation),
              0);
  }
  // Others pass over them, as Cesium does; a straight line is 10 m (70 s)^2 and more off in the middle.
  EXPECT_NEAR(off(*read(czml(cubic("LINEAR")))[0].track, 130), std::hypot(10 * 4900, 0.03 * 130 * 4900), 1);
  EXPECT_GT(off(*read(czml(cubic("LAGRANGE")))[0].track, 130), 49000);
  // Without velocities it is Lagrange's; a degree has no meaning with LINEAR (it was one of Lagrange's).
  const auto places = [](const std::string& how, int degree) {
    return read(czml(
        position("\"interpolationAlgorithm\": \"" + how + strf("\", \"interpolationDegree\": %d, ", degree))))[0]
        .track->at(333)
        .translation;
  };
  EXPECT_EQ(length(places("HERMITE", 5) - places("LAGRANGE", 5)), 0);
  EXPECT_EQ(length(places("LINEAR", 5) - places("LINEAR", 1)), 0);
  EXPECT_GT(length(places("LINEAR", 5) - places("LAGRANGE", 5)), 100);
}

TEST(EarthTracks, PositionsByIntervals) {
  const auto one = [](const char* begin, const char* end, const std::string& what) {
    return strf("{\"interval\": \"2026-06-21T10:%sZ/2026-06-21T10:%sZ\", ", begin, end) + what + "}";
  };
  const std::string here = "\"cartesian\": [7e6, 0, 0]", there = "\"cartesian\": [8e6, 0, 0]",
                    moves = "\"epoch\": \"2026-06-21T10:02:00Z\", \"cartesian\": [0, 7e6, 0, 0, 100, 7e6, 1000, 0]";
  const auto things = read(czml("\"position\": [" + one("01:00", "02:00", here) + ", " + one("03:00", "05:00", there) +
                                ", " + one("02:00", "02:30", moves) + "]"));
  ASSERT_EQ(things.size(), 3u);
  const auto at = [&](size_t i, double t) { return kFrame.ecef_from_enu(things[i].track->at(t).translation); };
  EXPECT_EQ(things[0].track->covered().begin, 60);
  EXPECT_LT(things[0].track->covered().end, 120);  // then the next is there
  EXPECT_NEAR(things[0].track->covered().end, 120, 1e-9);
  EXPECT_EQ(things[1].track->covered().begin, 120);
  EXPECT_EQ(things[1].track->covered().end, 150);
  EXPECT_NEAR(length(at(1, 140) - Vec3{7e6, 200, 0}), 0, 1e-6);
  EXPECT_NEAR(length(at(2, 200) - Vec3{8e6, 0, 0}), 0, 1e-6);
  // Turned by the same intervals, or once for all.
  const std::string half = "\"unitQuaternion\": [0, 0, 1, 0]", none = "\"unitQuaternion\": [0, 0, 0, 1]";
  const std::string two = "\"position\": [" + one("01:00", "02:00", here) + ", " + one("03:00", "05:00", there) + "], ";
  const auto turned =
      read(czml(two + "\"orientation\": [" + one("03:00", "05:00", half) + ", " + one("01:00", "02:00", none) + "]"));
  EXPECT_NEAR(length(kFrame.ecef_direction(turned[0].track->at(60).vector({0, 1, 0})) - Vec3{1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(length(kFrame.ecef_direction(turned[1].track->at(200).vector({0, 1, 0})) - Vec3{-1, 0, 0}), 0, 1e-12);
  const auto told = [](const std::string& packet) { return message_of([&] { read(czml(packet)); }); };
  EXPECT_THAT(told("\"position\": [" + one("01:00", "02:00", here) + ", " + one("01:59", "05:00", there) + "]"),
              HasSubstr("two places at one time"));
  EXPECT_THAT(told(two + "\"orientation\": [" + one("01:00", "05:00", half) + "]"), HasSubstr("other intervals"));
  // Two availabilities that overlap are one: it was there twice.
  EXPECT_EQ(read(czml("\"availability\": [\"2026-06-21T10:01:00Z/2026-06-21T10:05:00Z\", "
                      "\"2026-06-21T10:04:00Z/2026-06-21T10:06:00Z\"], " +
                      position("")))
                .size(),
            1u);
}

TEST(EarthTracks, OrientationIsThatOfTheirAxes) {
  // Their x forward along ECEF y, z up along ECEF z: a quarter turn about z.
  const auto turned =
      read(czml("\"orientation\": {\"unitQuaternion\": [0, 0, 0.70710678118654752, 0.70710678118654752]}, "
                "\"position\": {\"cartesian\": [6378137, 0, 0]}"));
  const Pose pose = turned[0].track->at(0);
  EXPECT_NEAR(length(kFrame.ecef_direction(pose.vector({0, 1, 0})) - Vec3{0, 1, 0}), 0, 1e-12);
  EXPECT_NEAR(length(kFrame.ecef_direction(pose.vector({1, 0, 0})) - Vec3{1, 0, 0}), 0, 1e-12);
  const auto along = read(czml("\"orientation\": {\"velocityReference\": \"#position\"}, " +
                               position("\"interpolationAlgorithm\": \"LAGRANGE\", \"interpolationDegree\": 5, ")));
  const Vec3 nose = kFrame.ecef_direction(along[0].track->at(360).vector({0, 1, 0}));
  EXPECT_NEAR(length(nose - Vec3{-std::sin(0.3), std::cos(0.3), 0}), 0, 1e-5);
}

TEST(EarthTracks, FaultsAreTold) {
  const auto told = [](const std::string& text, const MotionContext& context = kContext) {
    return message_of([&] { read(text, context); });
  };
  EXPECT_THAT(told(stk("CoordinateSystem J2000")), HasSubstr("export it with 'CoordinateSystem Fixed'"));
  EXPECT_THAT(told(stk("CoordinateSystem J2000")), HasSubstr("f.e:6"));
  EXPECT_THAT(told(stk("CentralBody Moon")), HasSubstr("Earth is understood"));
  EXPECT_THAT(told(stk("")), HasSubstr("no CoordinateSystem"));
  EXPECT_THAT(told(stk("CoordinateSystem Fixed\nInterpolationMethod Hermitian")), HasSubstr("Lagrange is understood"));
  EXPECT_THAT(told(stk("CoordinateSystem Fixed\nBEGIN SegmentBoundaryTimes")), HasSubstr("not understood"));
  EXPECT_THAT(told(stk("CoordinateSystem Fixed\nNumberOfEphemerisPoints 12")), HasSubstr("12 points are announced"));
  EXPECT_THAT(told(stk("CoordinateSystem Fixed", 0)), HasSubstr("nothing moves"));
  EXPECT_THAT(told(czml(position("\"referenceFrame\": \"INERTIAL\", "))), HasSubstr("referenceFrame FIXED"));
  EXPECT_THAT(told(czml(position("\"interpolationAlgorithm\": \"SPLINE\", "))), HasSubstr("LAGRANGE or HERMITE"));
  EXPECT_THAT(told(czml("\"position\": {\"cartesian\": [1, 2, 3, 4, 5]}")), HasSubstr("packet 'a': 5 numbers"));
  EXPECT_THAT(told(czml("\"position\": {\"cartesian\": [0, 7e6, 0, 0, 1, 7e6, 0, 0]}")), HasSubstr("without an epoch"));
  EXPECT_THAT(told(czml("\"position\": {\"cartesian\": [0, 0, 1]}")), HasSubstr("packet 'a': height"));
  EXPECT_THAT(told(czml("\"position\": {\"reference\": \"b#position\"}")), HasSubstr("cartographicDegrees"));
  EXPECT_THAT(told(czml("\"orientation\": {\"velocityReference\": \"#position\"}, \"position\": {\"epoch\": "
                        "\"2026-06-21T10:00:00Z\", \"cartographicDegrees\": [0, 9, 48, 0, 5, 9, 48, 0]}")),
              HasSubstr("rests"));
  EXPECT_THAT(told("[{\"id\": \"document\"}]"), HasSubstr("nothing moves"));
  // Without an origin, without a date, with a plane.
  EXPECT_THAT(told(stk("CoordinateSystem Fixed"), {}), HasSubstr("origin"));
  EXPECT_THAT(told(stk("CoordinateSystem Fixed"), {kFrame, {}, 0, nullptr}), HasSubstr("epoch"));
  const TrackFileOptions plane = track_file_options(Params::parse_text("height_m: 3", "s.yaml"), kContext);
  const std::string text = stk("CoordinateSystem Fixed");
  EXPECT_THAT(message_of([&] { track_file_of(text)->make(text, "f.e", plane); }), HasSubstr("'height_m' of a file"));
}

}  // namespace
}  // namespace suite::format_motion_earth_tracks_test
