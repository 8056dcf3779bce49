// Motion in scene files: what the text says, what the prepared scene keeps, what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/scene_text/scene_text.h"
#include "motion/track_record.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_scene_text_motion_test {
namespace {

using ::testing::HasSubstr;

const char* kHead =
    "scene: 1\norigin: {latitude_deg: 48.5, longitude_deg: 9.1, height_m: 400}\nepoch: 2024-05-01T10:00:00Z\n"
    "materials:\n  grey: {model: lambert, reflectance: 0.2}\nobjects:\n  tri: {obj: tri.obj, material: grey}\n";

class SceneMotion : public ::testing::Test {
 protected:
  SceneMotion() {
    write_file(folder_ / "tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_file(folder_ / "flight.csv",
               "time_s,east_m,north_m,up_m,heading_deg\n0,0,0,100,90\n10,500,0,100,90\n20,500,500,120,0\n");
  }
  Scene bake(const std::string& more) {
    write_file(folder_ / "s.yaml", kHead + more);
    report_ = Report(scene_issues());
    Draft draft = read_scene_text(folder_ / "s.yaml", {}, report_);
    inputs_ = draft.inputs;
    return bake_scene(draft, report_);
  }
  TempFolder folder_;
  Report report_{scene_issues()};
  std::vector<InputFile> inputs_;
};

const char* kAll = R"(times_s: [0, 20]
groups:
  rotor:
    - {place: tri, motion: {kind: spin, position_m: [0, 0, 3], axis: [0, 0, 1], rate_deg_s: 360, t0_s: 0.25}}
world:
  - {place: tri}
  - {place: rotor, motion: {kind: keyframes, file: flight.csv}, tag: helicopter}
  - {place: tri, scale: 2, motion: {kind: straight, latitude_deg: 48.51, longitude_deg: 9.1, height_m: 900, heading_deg: 10, speed_m_s: 80, follow_earth: true}}
  - {place: tri, motion: {kind: circle, position_m: [0, 0, 120], radius_m: 150, speed_m_s: 12, direction: clockwise, bank_deg: 5, pointing: {look_at: {position_m: [1, 2, 3]}}}}
  - {place: tri, motion: {kind: composed, outer: {kind: circle, position_m: [5, 5, 5], radius_m: 10, speed_m_s: 1}, inner: {kind: static, position_m: [1, 1, 1]}, pointing: nadir}}
  - place: tri
    motion:
      kind: keyframes
      keys:
        - {utc: "2024-05-01T09:59:00Z", latitude_deg: 48.5, longitude_deg: 9.1, height_m: 500}
        - {utc: "2024-05-01T10:01:00Z", latitude_deg: 48.5, longitude_deg: 9.2, height_m: 500}
)";

TEST_F(SceneMotion, StoredMotionsAreTheSameBitForBit) {
  const Scene made = bake(kAll);
  ASSERT_TRUE(report_.ok()) << report_.text();
  ASSERT_EQ(made.tracks.size(), 6u);
  EXPECT_EQ(made.groups[0].placements[0].track, kNone);
  EXPECT_EQ(made.epoch, "2024-05-01T10:00:00.000000000Z");
  write_scene(made, {"test", "", "", inputs_}, folder_ / "s.h5");
  const Scene read = read_scene(folder_ / "s.h5");
  ASSERT_EQ(read.tracks.size(), made.tracks.size());
  EXPECT_EQ(read.epoch, made.epoch);
  for (size_t g = 0; g < made.groups.size(); ++g)
    for (size_t k = 0; k < made.groups[g].placements.size(); ++k)
      EXPECT_EQ(read.groups[g].placements[k].track, made.groups[g].placements[k].track);
  for (size_t k = 0; k < made.tracks.size(); ++k) {
    EXPECT_EQ(read.tracks[k].name, made.tracks[k].name);
    EXPECT_EQ(read.tracks[k].track->covered().end, made.tracks[k].track->covered().end);
    for (const double t : {0.0, 3.7, 10.0, 19.9})
      EXPECT_EQ(read.tracks[k].track->at(t).affine(), made.tracks[k].track->at(t).affine()) << k;
  }
  // The table of poses is an input like any other file.
  EXPECT_TRUE(std::any_of(inputs_.begin(), inputs_.end(), [](const InputFile& f) { return f.name == "flight.csv"; }));
  // The bounds hold the whole flight, rotor included.
  EXPECT_GT(made.bounds.high.x, 500);
  EXPECT_GT(made.bounds.high.y, 499);
  EXPECT_GE(made.bounds.high.z, 123);
}

TEST_F(SceneMotion, PlacesAreWhereTheTextSays) {
  const Scene s = bake(kAll);
  ASSERT_TRUE(report_.ok()) << report_.text();
  // At 10 s the helicopter is 500 m east, heading east: its y (forward) is ENU x.
  const Track& flight = *s.tracks[s.groups[0].placements[1].track].track;
  EXPECT_NEAR(length(flight.at(10).point({0, 1, 0}) - Vec3{501, 0, 100}), 0, 1e-9);
  // A minute after second 0, on the way between the two dates: halfway in longitude at second 0.
  const SceneFrame frame({48.5, 9.1, 400});
  const Geodetic g = frame.geodetic_from_enu(s.tracks[s.groups[0].placements[5].track].track->at(60).translation);
  EXPECT_NEAR(g.longitude_deg, 9.2, 1e-9);
}

TEST_F(SceneMotion, FaultsAreToldWithTheirLine) {
  bake("times_s: [0, 30]\nworld:\n  - {place: tri}\n  - {place: tri, motion: {kind: keyframes, file: flight.csv}}\n");
  EXPECT_THAT(report_.text(), HasSubstr("SP407"));
  EXPECT_THAT(report_.text(), HasSubstr("s.yaml:11"));
  EXPECT_THAT(report_.text(), HasSubstr("known from 0 to 20 s, 'times_s' is 0 to 30 s"));
  bake("world:\n  - {place: tri, motion: {kind: keyframes, file: nothing.csv}}\n");
  EXPECT_THAT(report_.text(), HasSubstr("nothing.csv"));
  EXPECT_FALSE(report_.ok());
  bake(
      "world:\n  - {place: tri, motion: {kind: spin, position_m: [0, 0, 0], axis: [0, 0, 1], rate_deg_s: 1, speed: "
      "3}}\n");
  EXPECT_THAT(report_.text(), HasSubstr("speed"));
  // Inside a group a latitude means nothing.
  bake(
      "groups:\n  g: [{place: tri, motion: {kind: static, latitude_deg: 48, longitude_deg: 9, height_m: 0}}]\nworld: "
      "[{place: g}]\n");
  EXPECT_THAT(report_.text(), HasSubstr("origin"));
  bake(
      "world:\n  - {place: tri, motion: {kind: keyframes, keys: [{time_s: 0, position_m: [0, 0, 0]}, {time_s: 1, "
      "position_m: [0, 0, 0]}]}}\n"
      "  - {place: tri, motion: {kind: keyframes, keys: [{time_s: 2, position_m: [0, 0, 0]}, {time_s: 3, position_m: "
      "[0, 0, 0]}]}}\n");
  EXPECT_THAT(report_.text(), HasSubstr("no time in common"));
}

TEST(TrackRecords, BrokenOnesAreRefused) {
  TrackRecord r = static_track({})->record();
  EXPECT_EQ(track_of(r)->at(5).translation, Vec3{});
  r.numbers.pop_back();
  EXPECT_THAT(message_of([&] { track_of(r); }), HasSubstr("too few"));
  r.numbers.assign(9, 0.5);
  EXPECT_THROW(track_of(r), Error);
  r.kind = TrackRecord::Kind::composed;
  EXPECT_THAT(message_of([&] { track_of(r); }), HasSubstr("parts"));
  r.kind = static_cast<TrackRecord::Kind>(77);
  EXPECT_THAT(message_of([&] { track_of(r); }), HasSubstr("unknown kind"));
  OrbitElements e;
  e.satellite = "25544";
  e.epoch = {2024, 5, 1, 10, 0, 12.25};
  e.inclination = 0.9, e.eccentricity = 0.001, e.mean_motion = 0.0676;
  const SceneFrame frame({48.5, 9.1, 400});
  const TrackPtr orbit = orbit_track(std::make_shared<const Sgp4>(e), frame, Clock({2024, 5, 1, 10, 0, 0}), 0.1);
  const TrackPtr again = track_of(orbit->record());
  for (const double t : {0.0, 100.0, 5000.0}) EXPECT_EQ(again->at(t).affine(), orbit->at(t).affine());
}

}  // namespace
}  // namespace suite::format_scene_text_motion_test
