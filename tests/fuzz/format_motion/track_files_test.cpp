// Seeded mutations of files of tracks and of control tables: a list of things that move, or one Error.
#include <gtest/gtest.h>

#include "formats/motion/track_files.h"
#include "tests/support/fuzz.h"

namespace suite {
namespace {

std::string text_of(std::span<const std::byte> b) { return {reinterpret_cast<const char*>(b.data()), b.size()}; }

void read(const std::string& text, const TrackFileOptions& options) {
  if (const TrackFileRow* row = track_file_of(text))
    for (const MovingThing& thing : row->make(text, "f", options)) keyframe_track(thing.keys)->covered();
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
        [&](std::span<const std::byte> b) { read(text_of(b), options); }, 5, 20000, 4,
        {"<vehicle ", "<timestep ", "</timestep>", "<![CDATA[", "<!--", "<!DOCTYPE x [", "&#0;", "&lt;", "1e300", "nan",
         "time=\"", "id=\"a\"", "angle=\"-1e9\"", "/>"});
  }
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
             6, 20000, 4, {"period_s: 1e-6", "1e300", "-1", "rows: ", "time_s: ", "file: ", "true", "[", "{"});
}

}  // namespace
}  // namespace suite
