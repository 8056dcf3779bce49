// Traffic from a file of tracks in a scene text: each vehicle a placement of its type's object, tagged by its id,
// absent before its first record and after its last; types that nothing stands for are refused by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/scene_text/scene_text.h"
#include "motion/track.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "scene/presence.h"
#include "support/temp_folder.h"

namespace suite::format_scene_text_traffic_test {
namespace {

using ::testing::HasSubstr;

class Traffic : public ::testing::Test {
 protected:
  Traffic() {
    write_file(
        folder_ / "f.xml",
        "<fcd-export>\n<timestep time=\"0\"><vehicle id=\"a\" x=\"0\" y=\"0\" angle=\"90\" type=\"car\"/></timestep>\n"
        "<timestep time=\"1\"><vehicle id=\"a\" x=\"10\" y=\"0\" angle=\"90\" type=\"car\"/><vehicle id=\"b\" "
        "x=\"0\" y=\"50\" angle=\"0\" type=\"bus\"/></timestep>\n<timestep time=\"2\"><vehicle id=\"b\" x=\"0\" "
        "y=\"60\" angle=\"0\" type=\"bus\"/></timestep>\n</fcd-export>\n");
  }
  Scene bake(const std::string& world) {
    write_file(
        folder_ / "s.yaml",
        "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects:\n  body: {box: {x0: -1, y0: -4, "
        "z0: 0, x1: 1, y1: 0, z1: 1.5}, material: grey}\n" +
            world);
    report_ = Report(scene_issues());
    const Draft draft = read_scene_text(folder_ / "s.yaml", {}, report_);
    inputs_ = draft.inputs;
    return bake_scene(draft, report_);
  }
  TempFolder folder_;
  Report report_{scene_issues()};
  std::vector<InputFile> inputs_;
};

TEST_F(Traffic, EveryVehicleIsAPlacementWhileItHasRecords) {
  bake("world:\n  - {traffic: f.xml, begins: 100, types: {car: body}, default: {place: body, scale: 2, tag: other}}\n");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_TRUE(std::any_of(inputs_.begin(), inputs_.end(), [](const InputFile& f) { return f.name == "f.xml"; }));
  write_scene(bake("world:\n  - {traffic: f.xml, begins: 100, types: {car: body}, default: {place: body, scale: 2}}\n"),
              {"test", "", "", inputs_}, folder_ / "s.h5");
  const Scene s = read_scene(folder_ / "s.h5");
  const std::vector<Placement>& all = s.groups[0].placements;
  ASSERT_EQ(all.size(), 2u);
  for (const auto& [k, id, begin, end] : {std::tuple{0u, "a", 100.0, 101.0}, {1u, "b", 101.0, 102.0}}) {
    EXPECT_EQ(s.tags[all[k].tag], id);
    for (const double t : {99.9, 100.0, 100.5, 101.0, 101.5, 102.0, 102.1})
      EXPECT_EQ(made_at(s, all[k].track, all[k].schedule, t).has_value(), t >= begin && t <= end) << id << " " << t;
  }
  const Pose car = s.tracks[all[0].track].track->at(100.5);
  EXPECT_NEAR(length(car.translation - Vec3{5, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(all[1].to_parent.a[0], 2, 1e-12);
  // The bus on its way, twice as long as the car.
  EXPECT_NEAR(s.bounds.high.y, 60, 0.5);
  EXPECT_NEAR(s.bounds.low.x, -4, 0.1);
}

TEST_F(Traffic, FaultsAreTold) {
  const auto told = [&](const std::string& world) {
    bake(world);
    EXPECT_FALSE(report_.ok()) << world;
    return report_.text();
  };
  const std::string unknown = told("world:\n  - {traffic: f.xml, types: {car: body}}\n");
  EXPECT_THAT(unknown, HasSubstr("SP413"));
  EXPECT_THAT(unknown, HasSubstr("s.yaml:6"));
  EXPECT_THAT(unknown, HasSubstr("'bus' (1)"));
  EXPECT_THAT(told("world:\n  - {traffic: f.xml, default: bodie}\n"), HasSubstr("'body'"));
  EXPECT_THAT(
      told("world:\n  - {traffic: f.xml, default: {place: body, motion: {kind: static, position_m: [0, 0, 0]}}}\n"),
      HasSubstr("'motion' of what moves along a track of a file"));
  EXPECT_THAT(told("world:\n  - {traffic: s.yaml, default: body}\n"), HasSubstr("no file of tracks"));
  EXPECT_THAT(told("world:\n  - {traffic: f.xml, default: body, network: geographic}\n"), HasSubstr("origin"));
  EXPECT_THAT(told("world:\n  - {traffic: f.xml, default: body, netwrk: scene}\n"), HasSubstr("'network'"));
  EXPECT_THAT(told("world: [{place: g}]\ngroups: {g: [{traffic: f.xml, default: body}]}\n"), HasSubstr("'world' only"));
}

TEST_F(Traffic, OneObjectOfAFileIsATrack) {
  const Scene s =
      bake("world:\n  - {place: body, motion: {kind: keyframes, file: f.xml, object: b, outside: absent}}\n");
  ASSERT_TRUE(report_.ok()) << report_.text();
  EXPECT_NEAR(length(s.tracks[0].track->at(1.5).translation - Vec3{0, 55, 0}), 0, 1e-12);
  bake("world:\n  - {place: body, motion: {kind: keyframes, file: f.xml, object: c}}\n");
  EXPECT_THAT(report_.text(), HasSubstr("nothing of the id 'c'"));
}

}  // namespace
}  // namespace suite::format_scene_text_traffic_test
