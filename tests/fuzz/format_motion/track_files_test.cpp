// Seeded mutations of files of tracks and of control tables: a list of things that move, or one Error.
#include <gtest/gtest.h>

#include "formats/motion/track_files.h"
#include "tests/support/fuzz.h"

namespace suite::format_motion_track_files_test {
namespace {

std::string text_of(std::span<const std::byte> b) { return {reinterpret_cast<const char*>(b.data()), b.size()}; }

void read(const std::string& text, const TrackFileOptions& options) {
  if (const TrackFileRow* row = track_file_of(text))
    for (const MovingThing& thing : row->make(text, "f", options)) thing.track->covered();
}

TEST(TrackFilesFuzz, Fcd) {
  const MotionContext context{SceneFrame({48, 9, 0}), Clock({2024, 1, 1, 0, 0, 0}), 0, nullptr};
  TrackFileOptions options{context};
  for (const auto network : {TrackFileOptions::Network::scene, TrackFileOptions::Network::geographic}) {
    options.network = network;
    test::fuzz(
        test::bytes_of("<fcd-export><timestep time=\"0.00\"><vehicle id=\"a\" x=\"1\" y=\"2\" angle=\"3\" type=\"t\" "
                       "z=\"4\" slope=\"5\"/><person id=\"p\" x=\"1\" y=\"2\" angle=\"3\"/></timestep><timestep "
                       "time=\"1\"><vehicle id=\"a\" x=\"2\" y=\"2\" angle=\"3\" type=\"t\"/></timestep></fcd-export>"),
        [&](std::span<const std::byte> b) { read(text_of(b), options); }, 5, test::kMutations,
        {"<vehicle ", "<timestep ", "</timestep>", "<![CDATA[", "<!--", "<!DOCTYPE x [", "&#0;", "&lt;", "1e300", "nan",
         "time=\"", "id=\"a\"", "angle=\"-1e9\"", "/>"});
  }
}

TEST(TrackFilesFuzz, Czml) {
  const MotionContext context{SceneFrame({48, 9, 0}), Clock({2024, 1, 1, 0, 0, 0}), 0, nullptr};
  test::fuzz(
      test::bytes_of(
          "[{\"id\":\"document\"},{\"id\":\"a\",\"availability\":\"2024-01-01T00:00:00Z/2024-01-01T00:01:00Z\","
          "\"position\":{\"epoch\":\"2024-01-01T00:00:00Z\",\"interpolationAlgorithm\":\"LAGRANGE\","
          "\"interpolationDegree\":3,\"cartographicDegrees\":[0,9,48,5,10,9.1,48,5,20,9.2,48,6]},\"orientation\":"
          "{\"velocityReference\":\"#position\"}},{\"id\":\"b\",\"position\":{\"cartesian\":[7e6,0,0]},"
          "\"orientation\":{\"unitQuaternion\":[0,0,0,1]}},{\"id\":\"c\",\"position\":[{\"interval\":\"2024-01-01T00:"
          "00:00Z/"
          "2024-01-01T00:00:09Z\",\"epoch\":\"2024-01-01T00:00:00Z\",\"interpolationAlgorithm\":\"HERMITE\","
          "\"cartesianVelocity\":[0,7e6,0,0,1,2,3,9,7e6,9,9,1,2,3]},{\"interval\":\"2024-01-01T00:00:09Z/"
          "2024-01-01T00:01:00Z\",\"cartesian\":[7e6,0,0]}]}]"),
      [&](std::span<const std::byte> b) { read(text_of(b), {context}); }, 7, test::kMutations,
      {"cartesian", "LINEAR", "1e300", "-1", "\"interval\":", "[", "{", "null", "2024-02-30T00:00:00Z", "/", "FIXED"});
}

TEST(TrackFilesFuzz, Stk) {
  const MotionContext context{SceneFrame({48, 9, 0}), Clock({2024, 1, 1, 0, 0, 0}), 0, nullptr};
  test::fuzz(test::bytes_of("stk.v.11.0\nBEGIN Ephemeris\nNumberOfEphemerisPoints 3\nScenarioEpoch 1 Jan 2024 "
                            "00:00:00.0\nInterpolationMethod Lagrange\nInterpolationOrder 2\nCentralBody Earth\n"
                            "CoordinateSystem Fixed\nDistanceUnit Meters\nEphemerisTimePos\n0 7e6 0 0\n60 7e6 4e5 "
                            "0\n120 7e6 8e5 0\nEND Ephemeris\n"),
             [&](std::span<const std::byte> b) { read(text_of(b), {context}); }, 8, test::kMutations,
             {"EphemerisLLATimePosVel", "END", "BEGIN", "Kilometers", "1e300", "nan", "InterpolationSamplesM1 15", "#",
              "30 Feb 2024", "-1"});
}

TEST(TrackFilesFuzz, ControlTables) {
  const MotionContext context{SceneFrame({48, 9, 0}), Clock({2024, 1, 1, 0, 0, 0}), 0, nullptr};
  test::fuzz(test::bytes_of("period_s: 30\nrows:\n  - {time_s: 0, there: true, material: red}\n  - {utc: "
                            "\"2024-01-01T00:00:09Z\", there: false}\n  - {time_s: 12}\n"),
             [&](std::span<const std::byte> b) {
               const Params p = Params::parse_text(text_of(b), "f.yaml");
               const char* const columns[] = {"there", "material"};
               const TimedTable table = timetable_from(p, context, columns);
               p.reject_unread();
               size_t visits = 0;
               table.when.over({-1e3, 1e3}, [&](std::optional<size_t>, TimeSpan) { ++visits; });
               ASSERT_LE(visits, table.rows.size() + 2);
               for (const double t : {-1e12, 0.0, 7.5, 1e12})
                 if (const auto row = table.when.at(t)) {
                   ASSERT_LT(*row, table.rows.size());
                 }
             },
             6, test::kMutations, {"period_s: 1e-6", "1e300", "-1", "rows: ", "time_s: ", "file: ", "true", "[", "{"});
}

}  // namespace
}  // namespace suite::format_motion_track_files_test
