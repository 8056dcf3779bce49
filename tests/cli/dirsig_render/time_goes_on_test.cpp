// Sun and sky by date go on with the captures of a run: collectors over a day against a run for each hour, byte for
// byte; what is said of it; and the times of all lines in the headers of strips.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/run_command.h"

namespace suite::time_goes_on_test {
namespace {

using testing::HasSubstr;
using testing::Not;

const char* const kScene =
    "scene: 1\norigin: {latitude_deg: 49, longitude_deg: 8, height_m: 120}\n"
    "materials:\n  ground: {model: lambert, reflectance: 0.2}\n"
    "objects:\n  plane: {plane: {width: 40, depth: 40}, material: ground}\n  board: {box: {x0: -2, y0: -2, z0: 0, x1: "
    "2, y1: 2, z1: 3}, material: ground}\n"
    "world:\n  - {place: plane}\n  - {place: board, translate: [4, 0, 0]}\n";
const int kHours[] = {6, 9, 12, 18};

// Four collectors; at their hours after midnight, or all of them at second 0.
std::string collectors(bool at_their_hours) {
  std::string text = "sensors:\n";
  for (const int h : kHours)
    text += strf(
        "  - {kind: point, name: at_%02d, time_s: %d, paths: 64, collectors: [{name: level, quantity: irradiance, "
        "position_m: [0, 0, 1], normal: [0, 0, 1]}], bands: [{name: pan, center_um: 0.6, fwhm_um: 0.02, shape: "
        "rectangular}]}\n",
        h, at_their_hours ? h * 3600 : 0);
  return text;
}
std::string light(int hour, bool clear) {
  return strf("sun: {direction: {time_utc: \"2026-06-21T%02d:00:00Z\"}}\n%s", hour,
              clear ? "sky: {kind: clear}\n" : "atmosphere: {aerosol: {optical_depth_550: 0.2}}\n");
}

class TimeGoesOn : public testing::Test {
 protected:
  void SetUp() override {
    write_file(folder_ / "scene.yaml", std::string_view(kScene));
    ASSERT_EQ(run("scene-prep scene.yaml -o scene.h5 -q").code, 0);
  }
  CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/" + command);
  }
  CommandResult render(const std::string& text, const std::string& out) {
    write_file(folder_ / (out + ".yaml"), std::string_view("scene: scene.h5\n" + text));
    return run("dirsig-render " + out + ".yaml -o " + out);
  }
  std::string bytes(const std::string& name) { return read_text(folder_ / name); }
  TempFolder folder_;
};

TEST_F(TimeGoesOn, CollectorsOverADayAreThoseOfARunForEachHour) {
  for (const bool clear : {true, false}) {
    SCOPED_TRACE(clear);
    const std::string day = clear ? "day" : "air";
    // Second 0 is 0 h for the day. A clear sky cannot begin before sunrise, which second 0 itself need not see.
    CommandResult r = render(light(0, clear) + collectors(true), day);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.err, HasSubstr("first capture: sun at 2026-06-21T06:00:00"));
    EXPECT_THAT(r.err, HasSubstr("last capture: sun at 2026-06-21T18:00:00"));
    EXPECT_THAT(r.err, Not(HasSubstr("lasts")));
    std::string last;
    for (const int h : kHours) {
      SCOPED_TRACE(h);
      const std::string hour = strf("%s_%02d", day.c_str(), h), file = strf("/at_%02d.img", h);
      r = render(light(h, clear) + collectors(false), hour);
      ASSERT_EQ(r.code, 0) << r.err;
      EXPECT_EQ(bytes(day + file), bytes(hour + file));
      EXPECT_EQ(bytes(day + strf("/at_%02d_error.img", h)), bytes(hour + strf("/at_%02d_error.img", h)));
      EXPECT_NE(bytes(day + file), last);
      last = bytes(day + file);
    }
  }
}

TEST_F(TimeGoesOn, BadDatesAreRefused) {
  // A clear sky at night, with the capture that is at night; a sun that is not of the epoch's day.
  CommandResult r = render(light(16, true) + collectors(true), "night");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("night.yaml:2:"));
  EXPECT_THAT(r.err, HasSubstr("'at_06' of sensor 'at_06' is taken, it stands"));
  r = render("epoch: 2026-06-21T10:00:00Z\n" + light(12, false) + collectors(false), "two");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("error: the sun's date is not that of second 0, which is 2026-06-21T10:00"));
  r = render(light(12, false) + "moon: {direction: {time_utc: \"2026-06-21T13:00:00Z\"}}\n" + collectors(false),
             "moon");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("the moon's date is not that of second 0"));
  r = render("epoch: 2026-06-21T14:00:00+02:00\n" + light(12, false) + collectors(false), "same");
  EXPECT_EQ(r.code, 0) << r.err;
}

std::string strip(const std::string& readout, const std::string& tasks, const std::string& output = "") {
  return output +
         "sensors:\n  - kind: platform\n    name: uas\n    motion: {kind: straight, position_m: [0, -5, 100], "
         "heading_deg: "
         "0, speed_m_s: 10}\n    tasks: " +
         tasks + "\n    instruments:\n      - focal_length_mm: 50\n        name: broom\n        arrays: [{" + readout +
         ", pitch_um: 50, integration_time_s: 0.01, paths: 2, bands: [{name: pan, center_um: 0.6, fwhm_um: 0.1, shape: "
         "rectangular}]}]\n";
}

// Was the window of the capture that came first.
TEST_F(TimeGoesOn, HeadersOfStripsTellTheTimesOfAllLines) {
  const std::string line = "columns: 9, readout: {kind: line, line_rate_hz: 50, lines_per_capture: 7}",
                    two = "[{name: out, start: 1, stop: 2}, {name: back, start: 3, stop: 3.5}]";
  ASSERT_EQ(render(light(12, false) + strip(line, two), "strip").code, 0);
  const auto description = [&](const std::string& file) { return EnviImage(folder_ / file).header().description; };
  const std::string out =
                        "task 'out': line n = 1 to 50 from the top begins at 1 + (n - 1) x 0.02 s (n = 1: "
                        "2026-06-21T12:00:01.000000Z); each integrates 0.01 s; not mirrored: at its middle the "
                        "picture's bottom is towards 0.0 deg and its right towards 270.0 deg of the compass",
                    back = "task 'back': line n = 1 to 25 from the top begins at 3 + (n - 1) x 0.02 s";
  EXPECT_THAT(description("strip/uas_out.img"), HasSubstr("instrument 'broom', " + out));
  EXPECT_THAT(description("strip/uas_out_truth.img"), HasSubstr(out));
  EXPECT_THAT(description("strip/uas_back.img"), HasSubstr(back));
  ASSERT_EQ(render("output: {files: simulation}\n" + light(12, false) + strip(line, two), "all").code, 0);
  EXPECT_THAT(description("all/uas.img"), HasSubstr(out + "; " + back));
  ASSERT_EQ(render("output: {files: capture}\n" + light(12, false) + strip(line, two), "each").code, 0);
  EXPECT_THAT(description("each/uas_0001.img"), HasSubstr("1.14 to 1.27 s"));
  const CommandResult r = render(
      light(12, false) + strip("rows: 2, readout: {kind: whisk, samples: 11, sample_rate_hz: 80, scan_rate_hz: 5}",
                               "[{start: 0, stop: 2}]"),
      "whisk");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(description("whisk/uas.img"), HasSubstr("scan n = 1 to 10 from the top begins at 0 + (n - 1) x 0.2 s"));
  EXPECT_THAT(description("whisk/uas.img"), HasSubstr("has 2 lines; sample k = 1 to 11 from the "));
}

TEST_F(TimeGoesOn, CapturesInWhichTheSunMovesAreTold) {
  const std::string camera =
      "sensors: [{kind: orthographic, name: map, columns: 4, rows: 4, gsd_m: 1, center_m: [0, 0], "
      "time_s: 0, integration_time_s: 600, paths: 4, bands: [{name: pan, center_um: 0.6, fwhm_um: "
      "0.1}]}]\n";
  const CommandResult r = render(light(12, false) + camera, "long");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("warning: sensor 'map': capture 'map' lasts 600 s, in which the sun moves by 2."));
}

}  // namespace
}  // namespace suite::time_goes_on_test
