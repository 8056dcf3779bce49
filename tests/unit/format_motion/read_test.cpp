// Motion as users write it: every kind of track, every frame, tables, jitter, and located complaints.
#include "formats/motion/motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/files.h"
#include "formats/tle/tle.h"

namespace suite::format_motion_read_test {
namespace {

MotionContext earth() {
  return {SceneFrame({48.5, 9.1, 450}), Clock(parse_iso8601("2024-05-01T10:00:00Z")), 0.0,
          [](const std::string& path, const std::string& satellite) { return read_tle_of(path, satellite).elements; }};
}
Params yaml(const std::string& text) { return Params::parse_text(text, "m.yaml"); }
TrackPtr track(const std::string& text, const MotionContext& context = earth()) {
  const Params p = yaml(text);
  TrackPtr t = track_from(p, context);
  p.reject_unread();
  return t;
}
std::string complaint(const std::string& text, const MotionContext& context = earth()) {
  try {
    track(text, context);
    return "";
  } catch (const Error& e) {
    return e.what();
  }
}
double difference(const Pose& a, const Pose& b) {
  double worst = length(a.translation - b.translation);
  for (const Vec3 v : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    worst = std::fmax(worst, length(a.vector(v) - b.vector(v)));
  return worst;
}
using testing::HasSubstr;

TEST(MotionFormat, EveryKind) {
  EXPECT_LT(length(track("{kind: static, position_m: [1, 2, 3]}")->at(9).translation - Vec3{1, 2, 3}), 1e-15);
  const Pose east = track("{kind: static, east_m: 1, north_m: 2, up_m: 3, heading_deg: 90, pitch_deg: 10}")->at(0);
  EXPECT_LT(length(east.vector({0, 1, 0}) - Vec3{std::cos(10 * kDegree), 0, std::sin(10 * kDegree)}), 1e-15);
  const TrackPtr straight = track("{kind: straight, position_m: [0, 0, 100], heading_deg: 0, speed_m_s: 5, t0_s: 2}");
  EXPECT_LT(length(straight->at(4).translation - Vec3{0, 10, 100}), 1e-12);
  const TrackPtr curved =
      track("{kind: straight, position_m: [0, 0, 100], heading_deg: 45, speed_m_s: 200, follow_earth: yes}");
  EXPECT_NEAR(earth().frame->geodetic_from_enu(curved->at(500).translation).height_m, 550, 1e-6);
  const TrackPtr circle = track(
      "{kind: circle, position_m: [0, 0, 120], radius_m: 150, speed_m_s: 12, direction: clockwise, start_azimuth_deg: "
      "0,"
      " pointing: {look_at: {position_m: [0, 0, 0]}}}");
  EXPECT_LT(length(circle->at(0).translation - Vec3{0, 150, 120}), 1e-12);
  EXPECT_GT(circle->velocity(0).x, 11.9);
  EXPECT_LT(angle_between(circle->at(7).vector({0, 0, -1}), normalized(-circle->at(7).translation)), 1e-14);
  const TrackPtr spin = track("{kind: spin, position_m: [0, 0, 5], axis: [0, 0, 2], rate_deg_s: 90}");
  EXPECT_LT(length(spin->at(1).point({1, 0, 0}) - Vec3{0, 1, 5}), 1e-14);
  const TrackPtr keys = track(
      "{kind: keyframes, keys: [{time_s: 0, position_m: [0, 0, 0]}, {utc: '2024-05-01T10:00:04Z', position_m: [8, 0, "
      "0]}]}");
  EXPECT_LT(length(keys->at(1).translation - Vec3{2, 0, 0}), 1e-12);
  const TrackPtr both = track(
      "{kind: composed, outer: {kind: static, position_m: [10, 0, 0], heading_deg: 90},"
      " inner: {kind: static, position_m: [0, 1, 0]}}");
  EXPECT_LT(length(both->at(0).translation - Vec3{11, 0, 0}), 1e-14);
}

TEST(MotionFormat, OrbitsComeFromElementSets) {
  const std::string text = std::string("{kind: orbit, tle: '") + SUITE_TEST_DATA +
                           "/motion/SGP4-VER.TLE', satellite: '28057', dut1_s: 0.1, pointing: nadir}";
  MotionContext c = earth();
  c.clock = Clock(parse_iso8601("2006-06-27T00:00:00Z"));
  const double height = c.frame->geodetic_from_enu(track(text, c)->at(0).translation).height_m;
  EXPECT_GT(height, 7e5);
  EXPECT_LT(height, 8.2e5);
  EXPECT_THAT(complaint(text, {std::nullopt, c.clock, 0, c.satellites}), HasSubstr("needs a scene with an origin"));
  EXPECT_THAT(complaint(text, {c.frame, std::nullopt, 0, c.satellites}), HasSubstr("needs the date"));
}

// What is written in any frame's columns reads back as the same poses.
TEST(MotionFormat, TablesRoundTripInEveryFrame) {
  const MotionContext c = earth();
  std::vector<PoseKey> keys;
  for (int i = 0; i < 5; ++i)
    keys.push_back({i * 0.5, {platform_rotation(0.3 * i, 0.1, 0.02 * i), {100.0 * i, -50.0 * i, 1000.0 + i}}});
  for (const PoseColumns columns : {PoseColumns::enu, PoseColumns::ecef, PoseColumns::geodetic, PoseColumns::utm}) {
    const auto back = parse_pose_keys(pose_keys_text(keys, columns, c), "k.csv", c);
    ASSERT_EQ(back.size(), keys.size());
    for (size_t i = 0; i < keys.size(); ++i) {
      EXPECT_EQ(back[i].time, keys[i].time);
      EXPECT_LT(difference(back[i].pose, keys[i].pose), 1e-8) << static_cast<int>(columns);
    }
  }
  EXPECT_THROW(pose_keys_text(keys, PoseColumns::utm, {}), Error);
}

TEST(MotionFormat, TablesByBlanksAndFromFiles) {
  const auto keys = parse_pose_keys(
      "# flight\n\n  time_s  east_m north_m up_m heading_deg\r\n 0 0 0 +5 90\r\n1   3 0 5  90\n", "k.txt", {});
  ASSERT_EQ(keys.size(), 2u);
  EXPECT_EQ(keys[1].pose.translation, (Vec3{3, 0, 5}));
  EXPECT_LT(length(keys[0].pose.vector({0, 1, 0}) - Vec3{1, 0, 0}), 1e-15);
  const std::string path = (std::filesystem::temp_directory_path() / "suite_motion_keys.csv").string();
  write_pose_keys(path, keys, PoseColumns::enu, {});
  EXPECT_LT(length(track("{kind: keyframes, file: '" + path + "'}", {})->at(0.5).translation - Vec3{1.5, 0, 5}), 1e-12);
  std::filesystem::remove(path);
}

TEST(MotionFormat, TableFaultsAreLocated) {
  auto message = [](const std::string& text, const MotionContext& c = {}) -> std::string {
    try {
      parse_pose_keys(text, "k.csv", c);
      return "";
    } catch (const Error& e) {
      return e.what();
    }
  };
  EXPECT_THAT(message(""), HasSubstr("k.csv: error: a table without a row"));
  EXPECT_THAT(message("time_s,east_m,north_m,up_m\n"), HasSubstr("without a row"));
  EXPECT_THAT(message("time_s,east_m,noth_m,up_m\n0,0,0,0\n"),
              HasSubstr("k.csv:1:15: error: unknown column 'noth_m'; did you mean 'north_m'?"));
  EXPECT_THAT(message("time_s,east_m,east_m,up_m\n0,0,0,0\n"),
              HasSubstr("k.csv:1:15: error: column 'east_m' is there twice"));
  EXPECT_THAT(message("time_s,east_m,north_m,up_m\n0,0,x,0\n"),
              HasSubstr("k.csv:2:5: error: north_m is no number: 'x'"));
  EXPECT_THAT(message("time_s,east_m,north_m,up_m\n0,0,inf,0\n"), HasSubstr("is no number"));
  EXPECT_THAT(message("time_s,east_m,north_m,up_m\n0,0,0\n"),
              HasSubstr("k.csv:2:1: error: this row has 3 cells, the header 4"));
  EXPECT_THAT(message("time_s,east_m,north_m,up_m\n0,0,0,0\n0,1,1,1\n"),
              HasSubstr("k.csv:3:1: error: the times do not ascend"));
  EXPECT_THAT(message("east_m,north_m,up_m\n0,0,0\n"), HasSubstr("time_s or utc"));
  EXPECT_THAT(message("time_s,east_m,north_m\n0,0,0\n"), HasSubstr("a position has east_m but no up_m"));
  EXPECT_THAT(message("time_s,heading_deg\n0,0\n"), HasSubstr("a position is missing"));
  EXPECT_THAT(message("time_s,latitude_deg,longitude_deg,height_m\n0,0,0,0\n"),
              HasSubstr("needs a scene with an origin"));
  EXPECT_THAT(message("time_s,latitude_deg,longitude_deg,height_m\n0,95,0,0\n", earth()),
              HasSubstr("k.csv:2:1: error: latitude 95"));
  EXPECT_THAT(message("time_s,utm_zone,easting_m,northing_m,height_m\n0,99N,5e5,0,0\n", earth()),
              HasSubstr("'99N' is no UTM zone"));
  EXPECT_THAT(message("utc,east_m,north_m,up_m\n2024-01-01,0,0,0\n"), HasSubstr("need the date of the simulation"));
  EXPECT_THAT(message("utc,east_m,north_m,up_m\n2024-13-01,0,0,0\n", earth()), HasSubstr("k.csv:2:1: error: month 13"));
  EXPECT_THAT(message("time_s,east_m,north_m,up_m,ecef_y_m\n0,0,0,0,0\n"), HasSubstr("both east_m and ecef_y_m"));
  EXPECT_THAT(message("time_s,east_m,north_m,up_m,qw,qx,qy,qz\n0,0,0,0,2,0,0,0\n"),
              HasSubstr("a quaternion of length 2"));
  EXPECT_THAT(message("time_s,east_m,north_m,up_m,qw,heading_deg\n0,0,0,0,1,0\n"),
              HasSubstr("both as angles and as a quaternion"));
  EXPECT_THAT(message("time_s,east_m,north_m,up_m,qw\n0,0,0,0,1\n"), HasSubstr("a quaternion without qx"));
}

TEST(MotionFormat, YamlFaultsAreLocated) {
  EXPECT_THAT(complaint("{kind: statik, position_m: [0, 0, 0]}"), HasSubstr("m.yaml:1:8: error"));
  EXPECT_THAT(complaint("{kind: statik, position_m: [0, 0, 0]}"), HasSubstr("static"));
  EXPECT_THAT(complaint("{kind: static}"), HasSubstr("a position is missing"));
  EXPECT_THAT(complaint("{kind: static, position_m: [0, 0]}"), HasSubstr("needs a list of 3 numbers"));
  EXPECT_THAT(complaint("{kind: static, position_m: [0, 0, 0], east_m: 1}"), HasSubstr("both east_m and position_m"));
  EXPECT_THAT(complaint("{kind: static, position_m: [0, 0, 0], headingdeg: 1}"), HasSubstr("heading_deg"));
  EXPECT_THAT(complaint("{kind: static, position_m: [0, 0, 0], pitch_deg: 100}"), HasSubstr("pitch"));
  EXPECT_THAT(complaint("{kind: straight, position_m: [0, 0, 0], heading_deg: 0, speed_m_s: -1}"),
              HasSubstr("m.yaml:1:"));
  EXPECT_THAT(complaint("{kind: circle, position_m: [0, 0, 0], radius_m: 0, speed_m_s: 1}"),
              HasSubstr("a circle of radius 0"));
  EXPECT_THAT(complaint("{kind: spin, position_m: [0, 0, 0], axis: [0, 0, 0], rate_deg_s: 1}"),
              HasSubstr("axis of no direction"));
  EXPECT_THAT(complaint("{kind: keyframes, keys: []}"), HasSubstr("without a single keyframe"));
  EXPECT_THAT(
      complaint("{kind: keyframes, keys: [{time_s: 1, position_m: [0, 0, 0]}, {time_s: 1, position_m: [0, 0, 0]}]}"),
      HasSubstr("the times do not ascend"));
  EXPECT_THAT(complaint("{kind: keyframes, file: nowhere.csv}"), HasSubstr("nowhere.csv"));
  EXPECT_THAT(complaint("{kind: static, position_m: [0, 0, 0], pointing: upwards}"), HasSubstr("nadir"));
  EXPECT_THAT(complaint("{kind: static, latitude_deg: 0, longitude_deg: 0, height_m: 0}", {}),
              HasSubstr("needs a scene with an origin"));
  std::string nested = "{kind: static, position_m: [0, 0, 0]}";
  for (int i = 0; i < 70; ++i)
    nested = "{kind: composed, inner: {kind: static, position_m: [0, 0, 0]}, outer: " + nested + "}";
  EXPECT_THAT(complaint(nested), HasSubstr("nested too deeply"));
}

TEST(MotionFormat, Jitter) {
  auto read = [](const std::string& text) {
    const Params p = yaml(text);
    const class Jitter j = jitter_from(p, 5);
    p.reject_unread();
    return j;
  };
  const auto j = read(
      "{seed: 3, components: 64, x: {sigma_m: 0, mean_m: 2}, rotate_z: {mean_rad: 0.5, psd: {frequency_hz: [1, 10], "
      "density_rad2_hz: [1e-4, 1e-4], between: linear}}}");
  EXPECT_EQ(j.at(1)[0], 2);
  EXPECT_NE(j.at(1)[5], 0.5);
  EXPECT_NEAR(j.at(1)[5], 0.5, 0.3);
  EXPECT_THROW(read("{x: {mean_m: 1}}"), Error);
  EXPECT_THROW(read("{x: {sigma_rad: 1}}"), Error);
  EXPECT_THROW(read("{w: {sigma_m: 1}}"), Error);
  EXPECT_THROW(read("{x: {sigma_m: -1}}"), Error);
  EXPECT_THROW(read("{x: {psd: {frequency_hz: [1, 1], density_m2_hz: [1, 1]}}}"), Error);
  EXPECT_THROW(read("{x: {sigma_m: 1}, components: 5}"), Error);
  const std::string path = (std::filesystem::temp_directory_path() / "suite_motion_psd.csv").string();
  write_file(path, std::string_view("frequency_hz,density_m2_hz\n1,1e-6\n100,1e-10\n"));
  EXPECT_NE(read("{x: {psd: {file: '" + path + "'}}}").at(0.3)[0], 0);
  EXPECT_THROW(read("{rotate_x: {psd: {file: '" + path + "'}}}"), Error);  // the wrong unit
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace suite::format_motion_read_test
