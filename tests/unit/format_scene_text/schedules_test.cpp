// Lifetimes and control tables of placements: what the text says, what the prepared scene keeps, what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/scene_text/scene_text.h"
#include "motion/track.h"
#include "scene/bake.h"
#include "scene/combine.h"
#include "scene/issues.h"
#include "scene/presence.h"
#include "support/temp_folder.h"

namespace suite::format_scene_text_schedules_test {
namespace {

using ::testing::HasSubstr;

const char* kHead =
    "scene: 1\norigin: {latitude_deg: 48.5, longitude_deg: 9.1, height_m: 400}\nepoch: 2024-05-01T10:00:00Z\n"
    "materials:\n  grey: {model: lambert, reflectance: 0.2}\n  red: {model: lambert, reflectance: 0.4}\n"
    "objects:\n  ball: {sphere: {radius: 1}, material: grey}\n";

class Schedules : public ::testing::Test {
 protected:
  Scene bake(const std::string& more) {
    write_file(folder_ / "s.yaml", kHead + more);
    report_ = Report(scene_issues());
    const Draft draft = read_scene_text(folder_ / "s.yaml", {}, report_);
    inputs_ = draft.inputs;
    return bake_scene(draft, report_);
  }
  // What a placement of the root is made of at a time: its name, "" for its own, "-" while it is not there.
  static std::string made(const Scene& s, size_t placement, double t) {
    const Placement& p = s.groups[0].placements[placement];
    const auto m = made_at(s, p.track, p.schedule, t);
    return !m ? "-" : *m == kNone ? "" : s.materials[*m].id;
  }
  TempFolder folder_;
  Report report_{scene_issues()};
  std::vector<InputFile> inputs_;
};

const char* kAll = R"(world:
  - {place: ball}
  - {place: ball, appears: 2, disappears: "2024-05-01T10:00:05Z"}
  - {place: ball, schedule: [{time_s: 1, there: false}, {utc: "2024-05-01T10:00:03Z", material: red}, {time_s: 4}]}
  - {place: ball, schedule: {file: lights.csv, period_s: 10}}
  - place: ball
    motion: {kind: keyframes, outside: absent, keys: [{time_s: 1, position_m: [0, 0, 0]}, {time_s: 3, position_m: [9, 0, 0]}]}
)";

TEST_F(Schedules, SayWhatIsThereWhenAndSurviveTheFile) {
  write_file(folder_ / "lights.csv", "time_s,there,material\n0,true,\n4,true,red\n6,false,\n");
  const Scene first = bake(kAll);
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_TRUE(std::any_of(inputs_.begin(), inputs_.end(), [](const InputFile& f) { return f.name == "lights.csv"; }));
  write_scene(first, {"test", "", "", inputs_}, folder_ / "s.h5");
  const Scene stored = read_scene(folder_ / "s.h5");
  Scene later = read_scene(folder_ / "s.h5");
  set_epoch(later, "2024-05-01T09:59:00Z");  // second 0 a minute earlier
  for (const Scene* which : {&first, &stored, &std::as_const(later)}) {
    const Scene& scene = *which;
    const double zero = which == &later ? 60 : 0;
    EXPECT_TRUE(changes_in_time(scene));
    for (int k = -4; k < 40; ++k) {
      const double s = 0.5 * k, t = s + zero, cycle = s - 10 * std::floor(s / 10);
      EXPECT_EQ(made(scene, 0, t), "");
      EXPECT_EQ(made(scene, 1, t), s >= 2 && s < 5 ? "" : "-") << s;
      EXPECT_EQ(made(scene, 2, t), s < 1 ? "" : s < 3 ? "-" : s < 4 ? "red" : "") << s;
      EXPECT_EQ(made(scene, 3, t), cycle < 4 ? "" : cycle < 6 ? "red" : "-") << s;
      EXPECT_EQ(made(scene, 4, t), s >= 1 && s <= 3 ? "" : "-") << s;
    }
  }
}

TEST_F(Schedules, CountInTheExtentWhileTheyAreThere) {
  const Scene all = bake(kAll + std::string("#"));
  EXPECT_FALSE(report_.ok()) << "lights.csv is not there";
  const std::string passing = std::string(kAll).substr(0, std::string(kAll).find("  - {place: ball, schedule: {file")) +
                              std::string(kAll).substr(std::string(kAll).find("  - place: ball\n"));
  // Without times_s all that passes counts, with them what is there then.
  EXPECT_NEAR(bake(passing).bounds.high.x, 10, 0.1);
  EXPECT_TRUE(report_.ok()) << report_.text();
  EXPECT_NEAR(bake("times_s: [0, 2]\n" + passing).bounds.high.x, 5.5, 0.1);
  EXPECT_NEAR(bake("times_s: [5, 9]\n" + passing).bounds.high.x, 1, 1e-9);
  EXPECT_TRUE(report_.ok()) << report_.text();
}

TEST_F(Schedules, FaultsAreToldWithTheirLine) {
  const auto told = [&](const std::string& placement) {
    bake("world:\n  - {place: ball}\n  - {place: ball, " + placement + "}\n");
    EXPECT_FALSE(report_.ok()) << placement;
    return report_.text();
  };
  const std::string ended = told("appears: 5, disappears: 5");
  EXPECT_THAT(ended, HasSubstr("SP412"));
  EXPECT_THAT(ended, HasSubstr("s.yaml:11"));
  EXPECT_THAT(ended, HasSubstr("disappears at 5 s and appears at 5 s"));
  EXPECT_THAT(told("schedule: [{time_s: 2}, {time_s: 1}]"), HasSubstr("do not ascend"));
  EXPECT_THAT(told("schedule: []"), HasSubstr("without a row"));
  EXPECT_THAT(told("schedule: [{time_s: 2, there: perhaps}]"), HasSubstr("neither true nor false"));
  EXPECT_THAT(told("schedule: [{time_s: 2, material: rde}]"), HasSubstr("'red'"));
  EXPECT_THAT(told("schedule: [{time_s: 2, ther: true}]"), HasSubstr("'there'"));
  EXPECT_THAT(told("schedule: {rows: [{time_s: 0}, {time_s: 9}], period_s: 9}"), HasSubstr("period"));
  EXPECT_THAT(told("schedule: {file: none.csv}"), HasSubstr("none.csv"));
  // A motion is needed while its placement lives, whatever the run looks at.
  EXPECT_THAT(told("appears: 0, disappears: 4, motion: {kind: keyframes, keys: [{time_s: 1, position_m: [0, 0, 0]}, "
                   "{time_s: 5, position_m: [1, 0, 0]}]}"),
              HasSubstr("known from 1 to 5 s, its life is 0 to 4 s"));
  // Media fill space all the time.
  bake(
      "media: {m: {scattering: 1, absorption: 0}}\ngrids: {g: {voxels: g.vox, medium: m}}\nvolumes: [{place: g, "
      "motion: "
      "{kind: spin, outside: absent, position_m: [0, 0, 0], axis: [0, 0, 1], rate_deg_s: 1}}]\nworld: [{place: "
      "ball}]\n");
  EXPECT_THAT(report_.text(), HasSubstr("only placements of a scene can be absent"));
}

}  // namespace
}  // namespace suite::format_scene_text_schedules_test
