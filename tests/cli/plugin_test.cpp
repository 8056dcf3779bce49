// A sensor from outside: built by its own CMakeLists against the installed package, loaded, used; and what happens to
// those that break the rules.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/run_command.h"

namespace suite {
namespace {

using testing::HasSubstr;

class Plugin : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    build_ = run_command("cd '" + folder_->path() +
                         "' && cmake --install '" SUITE_BUILD_DIR
                         "' --component sdk --prefix prefix && cmake -S '" SUITE_SOURCE_DIR
                         "/tests/plugin' -B build -DCMAKE_PREFIX_PATH=\"$PWD/prefix\" && cmake --build build");
    write_file(*folder_ / "scene.yaml",
               std::string_view("scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.5}}\nobjects: {p: {plane: "
                                "{width: 0, depth: 0}, material: grey}}\nworld: [{place: p}]\n"));
    prep_ = run_command("cd '" + folder_->path() + "' && " SUITE_BIN_DIR "/scene-prep scene.yaml -o scene.h5 -q");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  // Renders one sensor with a plug-in of the example.
  static CommandResult render(const std::string& sensor, const std::string& plugin, const std::string& out) {
    write_file(*folder_ / (out + ".yaml"),
               std::string_view("scene: scene.h5\nsky: {radiance: 1}\nsensors: [" + sensor + "]\n"));
    return run_command("cd '" + folder_->path() + "' && " SUITE_BIN_DIR "/dirsig-render " + out + ".yaml -o " + out +
                       " -q --plugin build/lib" + plugin + ".so");
  }
  static TempFolder* folder_;
  static CommandResult build_, prep_;
};
TempFolder* Plugin::folder_ = nullptr;
CommandResult Plugin::build_, Plugin::prep_;

TEST_F(Plugin, BuildsAgainstTheInstalledPackageAlone) {
  EXPECT_EQ(build_.code, 0) << build_.out << build_.err;
  EXPECT_EQ(prep_.code, 0) << prep_.err;
  EXPECT_TRUE(file_exists(*folder_ / "prefix/include/suite/suite_sensor.h"));
}

TEST_F(Plugin, Renders) {
  const CommandResult r = render("{kind: grid_camera, name: grid, pixels: 8}", "grid_camera", "grid");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, HasSubstr("grid_camera: mean radiance 0.500000"));  // it saw its result
  const EnviImage image(*folder_ / "grid/grid.img"), truth(*folder_ / "grid/grid_truth.img");
  EXPECT_EQ(image.header().samples, 8u);
  EXPECT_EQ(image.header().band_names, (std::vector<std::string>{"green", "red"}));
  for (const double v : image.read_all()) EXPECT_NEAR(v, 0.5, 1e-6);
  EXPECT_EQ(truth.header().band_names, (std::vector<std::string>{"material", "range [m]"}));
  EXPECT_NEAR(truth.read_all()[1], 1000, 1e-6);
}

TEST_F(Plugin, SaysHowManyPathsEachProblemMayTake) {
  const CommandResult r =
      render("{kind: grid_camera, name: grid, pixels: 8, paths: 4, first_paths: 40}", "grid_camera", "picky");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, HasSubstr("40 paths in the first pixel, 4 in the last"));
}

TEST_F(Plugin, MayWeighWavelengths) {
  const CommandResult r = render("{kind: grid_camera, name: grid, pixels: 1, unit_um: 0.6}", "grid_camera", "weighed");
  ASSERT_EQ(r.code, 0) << r.err;
  const std::vector<double> bands = EnviImage(*folder_ / "weighed/grid.img").read_all();
  ASSERT_EQ(bands.size(), 2u);
  EXPECT_NEAR(bands[0], 0.5 * 0.55 / 0.6, 1e-6);
  EXPECT_NEAR(bands[1], 0.5 * 0.65 / 0.6, 1e-6);
}

TEST_F(Plugin, MayCollectOverAHemisphere) {
  const CommandResult r = render("{kind: irradiance_meter, name: meter}", "irradiance_meter", "meter");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NEAR(EnviImage(*folder_ / "meter/meter.img").read_all().at(0), 3.14159265, 1e-6);  // pi times the sky's
}

TEST_F(Plugin, UsersMistakesAreLocated) {
  CommandResult r = render("{kind: grid_camera, pixles: 8}", "grid_camera", "typo");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("typo.yaml:3:"));
  EXPECT_THAT(r.err, HasSubstr("did you mean 'pixels'?"));
  r = render("{kind: grid_camera, pixels: many}", "grid_camera", "text");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("text.yaml:3:"));
  r = render("{kind: grid_camera, pixels: 0}", "grid_camera", "zero");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("pixels must be 1 to 4096"));
}

TEST_F(Plugin, OfAnotherVersionIsRefusedWithASentence) {
  const CommandResult r = render("{kind: future_sensor}", "future_sensor", "future");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("was built for version 42 of the sensor interface, this program has version 1"));
}

TEST_F(Plugin, WhatIsNoPluginIsRefused) {
  CommandResult r =
      run_command("cd '" + folder_->path() + "' && " SUITE_BIN_DIR "/dirsig-render grid.yaml --plugin scene.h5");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("cannot be loaded as a plug-in"));
  r = run_command("cd '" + folder_->path() +
                  "' && " SUITE_BIN_DIR
                  "/dirsig-render grid.yaml --plugin build/libgrid_camera.so --plugin build/libgrid_camera.so");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("there is a sensor kind 'grid_camera' already"));
}

TEST_F(Plugin, BadRaysAndExceptionsAreContained) {
  for (const std::string trouble : {"nan", "direction", "weight", "throw"}) {
    const CommandResult r =
        render("{kind: troublemaker, name: bad, trouble: " + trouble + "}", "troublemaker", trouble);
    ASSERT_EQ(r.code, 0) << trouble << r.err;
    EXPECT_THAT(r.err, HasSubstr("rejected 128 samples that were not finite or negative"));
    const std::vector<double> image = EnviImage(*folder_ / (trouble + "/bad.img")).read_all();
    for (size_t i = 1; i < image.size(); i += 2)
      EXPECT_NEAR(image[i], 0.5, 1e-6);  // the good pixels are as they should be
  }
  for (const std::string trouble : {"make", "accept", "task", "goal", "no_goal"}) {
    const CommandResult r = render("{kind: troublemaker, trouble: " + trouble + "}", "troublemaker", trouble);
    EXPECT_EQ(r.code, 1) << trouble;
    EXPECT_THAT(r.err, HasSubstr(trouble == "goal" ? "asks for 16 to 0 paths" : "plug-in 'troublemaker'"));
  }
}

}  // namespace
}  // namespace suite
