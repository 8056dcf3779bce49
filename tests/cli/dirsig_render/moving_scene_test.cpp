// Two prepared scenes in one simulation, one of them with a moving car: pictures at two times, a picture of a window,
// and faults told before anything is rendered.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/run_command.h"

namespace suite::moving_scene_test {
using testing::HasSubstr;

namespace {

const std::string kBin = SUITE_BIN_DIR "/";

class MovingScene : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    put("ground.yaml",
        "scene: 1\norigin: {latitude_deg: 48, longitude_deg: 9, height_m: 100}\nmaterials: {black: {model: lambert, "
        "reflectance: 0}}\n"
        "objects: {ground: {plane: {width: 200, depth: 200}, material: black}}\nworld: [{place: ground}]\n");
    put("traffic.yaml",
        "scene: 1\norigin: {latitude_deg: 48, longitude_deg: 9, height_m: 100}\ntimes_s: [0, 10]\nmaterials: {white: "
        "{model: lambert, reflectance: 1}}\n"
        "objects: {car: {box: {x0: -2, y0: -2, z0: 0, x1: 2, y1: 2, z1: 1}, material: white}}\n"
        "world:\n  - place: car\n    tag: car\n    motion: {kind: keyframes, keys: [{time_s: 0, position_m: [-20, 0, "
        "0]}, {time_s: 10, position_m: [20, 0, 0]}]}\n");
    ground_ = run("scene-prep ground.yaml -o ground.h5 -q");
    traffic_ = run("scene-prep traffic.yaml -o traffic.h5 -q");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static void put(const std::string& name, const std::string& text) { write_file(*folder_ / name, text); }
  static CommandResult run(const std::string& command) {
    return run_command("cd " + folder_->path() + " && " + kBin + command);
  }
  // A row of 16 pixels, 4 m each on the ground, from west to east; collimated sun from the zenith.
  static CommandResult picture(const std::string& name, const std::string& times) {
    put(name + ".yaml",
        "scenes: [ground.h5, traffic.h5]\nsun: {direction: {zenith_deg: 0, azimuth_deg: 0}, collimated: true, "
        "irradiance: 3.14159265358979}\nsensors:\n"
        "  - {kind: frame_camera, name: " +
            name +
            ", columns: 16, rows: 1, pitch_um: 4, focal_length_mm: 1, position_m: [0, 0, 1000], look_at_m: [0, 0, "
            "0], " +
            times + ", bands: [{name: b, center_um: 0.55, fwhm_um: 0.01, shape: rectangular}], paths: 256}\n");
    return run("dirsig-render " + name + ".yaml -o out -q");
  }
  static std::vector<double> row(const std::string& name) {
    return EnviImage(*folder_ / ("out/" + name + ".img")).read_all();
  }

  static TempFolder* folder_;
  static CommandResult ground_, traffic_;
};
TempFolder* MovingScene::folder_ = nullptr;
CommandResult MovingScene::ground_, MovingScene::traffic_;

TEST_F(MovingScene, TheCarIsWhereItIsAtTheTime) {
  ASSERT_EQ(ground_.code, 0) << ground_.err;
  ASSERT_EQ(traffic_.code, 0) << traffic_.err;
  for (const auto& [name, time, pixel] :
       {std::tuple{"begin", "0", 3}, std::tuple{"middle", "4.5", 7}, std::tuple{"end", "10", 13}}) {
    const CommandResult r = picture(name, std::string("time_s: ") + time);
    ASSERT_EQ(r.code, 0) << r.err;
    const std::vector<double> l = row(name);
    ASSERT_EQ(l.size(), 16u);
    // The roof is a metre nearer and a white Lambert surface under normal irradiance pi has radiance 1.
    for (size_t i = 0; i < 16; ++i) {
      const double west = -32 + 4.0 * static_cast<double>(i), x = -20 + 4 * std::atof(time);
      const double covered = std::max(0.0, std::min(west + 4, x + 2) - std::max(west, x - 2)) / 4;
      EXPECT_NEAR(l[i], covered, 0.03) << name << " " << i;
    }
    EXPECT_GT(l[static_cast<size_t>(pixel)], 0.4);
  }
}

TEST_F(MovingScene, AWindowSmearsItEvenly) {
  const CommandResult r = picture("smear", "time_s: 3, integration_time_s: 4");
  ASSERT_EQ(r.code, 0) << r.err;
  const std::vector<double> l = row("smear");
  // From -8 m to 8 m in the window: a place inside is covered for a quarter of it.
  for (const size_t i : {7u, 8u}) EXPECT_NEAR(l[i], 0.25, 0.03);
  EXPECT_NEAR(l[2], 0, 1e-6);
}

TEST_F(MovingScene, FaultsAreToldBeforeRendering) {
  const CommandResult late = picture("late", "time_s: 9, integration_time_s: 2");
  EXPECT_EQ(late.code, 1);
  EXPECT_THAT(late.err, HasSubstr("known from 0 to 10 s, it is needed from 9 to 11 s"));
  EXPECT_THAT(late.err, HasSubstr("late.yaml"));
  put("lost.yaml",
      "scene: 1\nmaterials: {white: {model: lambert, reflectance: 1}}\nobjects: {p: {plane: {width: 1, depth: 1}, "
      "material: white}}\nworld: [{place: p}]\n");
  ASSERT_EQ(run("scene-prep lost.yaml -o lost.h5 -q").code, 0);
  put("sim.yaml",
      "scenes: [ground.h5, lost.h5]\nsun: {direction: {zenith_deg: 0, azimuth_deg: 0}, irradiance: 3}\nsensors:\n"
      "  - {kind: frame_camera, columns: 1, rows: 1, pitch_um: 4, focal_length_mm: 1, position_m: [0, 0, 1000], "
      "look_at_m: [0, 0, 0], bands: [{name: b, center_um: 0.55, fwhm_um: 0.01}], paths: 4}\n");
  const CommandResult lost = run("dirsig-render sim.yaml -o out -q");
  EXPECT_EQ(lost.code, 1);
  EXPECT_THAT(lost.err, HasSubstr("'lost' has no origin on the Earth"));
}

}  // namespace

}  // namespace suite::moving_scene_test
