// A sensor from outside: built by its own CMakeLists against the installed package, loaded, used; and what happens to
// those that break the rules.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "motion/scene_frame.h"
#include "sensor/sensor.h"
#include "spectral/state.h"
#include "support/run_command.h"

namespace suite::plugin_test {
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

// Structures that grew since leave plug-ins of smaller ones alone.
TEST_F(Plugin, OfOlderHeadersGoOnWorking) {
  for (const std::string version : {"1.0", "1.2", "1.3"}) {
    const CommandResult r =
        render("{kind: old_camera, name: old, paths: 8}", "old_camera_" + version, "old_" + version);
    ASSERT_EQ(r.code, 0) << version << r.err;
    const std::vector<double> image = EnviImage(*folder_ / ("old_" + version + "/old.img")).read_all();
    ASSERT_EQ(image.size(), 16u);
    for (const double v : image) EXPECT_NEAR(v, 0.5, 1e-6) << version;
  }
}

// A table of numbers with a line of names above.
struct Table {
  std::vector<std::vector<double>> rows;
  explicit Table(const std::string& path) {
    std::istringstream in(read_text(path));
    std::string line, cell;
    std::getline(in, line);
    while (std::getline(in, line)) {
      rows.emplace_back();
      std::istringstream cells(line);
      while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
    }
  }
};
// What a plug-in calls its weights of wavelengths: those of the example.
double square_of(double um) { return um / 0.6 * um / 0.6; }

TEST_F(Plugin, KnowsTheBinsThatBandsAreMadeOf) {
  const CommandResult r = render("{kind: field_notes, name: notes, spectral_error: 0}", "field_notes", "notes");
  ASSERT_EQ(r.code, 0) << r.err;
  const Table bins(*folder_ / "notes/notes/bins.csv");
  ASSERT_GT(bins.rows.size(), 20u);
  const Band bands[] = {Band::gaussian("green", 0.55, 0.04), Band::rectangular("red", 0.65, 0.03)};
  const std::vector<double> image = EnviImage(*folder_ / "notes/notes.img").read_all();
  for (size_t b = 0; b < 2; ++b) {
    double all = 0, linear = 0, weighed = 0;
    for (const auto& bin : bins.rows) {
      EXPECT_LT(bin[0], bin[1]);
      const double um = 0.5 * (bin[0] + bin[1]);
      all += bin[2 + b], linear += bin[2 + b] * um, weighed += bin[2 + b] * square_of(um);
    }
    EXPECT_NEAR(all, 1, 1e-12);
    // A smooth function over the bins has its mean over the band; the sky over the ground is 0.5 of it everywhere.
    const Curve line({0.3, 0.8}, {0.3, 0.8}, Outside::error);
    EXPECT_NEAR(linear, band_mean(bands[b], line), 1e-6) << bands[b].name;
    const double middle = bands[b].center_um, spread = b ? 0.03 * 0.03 / 12 : 0.04 * 0.04 / (8 * std::log(2.0));
    EXPECT_NEAR(weighed, (middle * middle + spread) / 0.36, 2e-5) << "of a Gaussian and of a box";
    EXPECT_NEAR(image.at(b) / 0.5, weighed, 1e-6) << "what the program made of the plug-in's weights";
    EXPECT_GT(std::fabs(weighed - square_of(middle)), 1e-4) << "a plug-in that knew the centres only would be off";
  }
}

// One g-point of weight 1 in each interval; a plug-in that was built before they had a name gets the same bins.
TEST_F(Plugin, BinsAreIntervalGPointAndWeight) {
  ASSERT_EQ(render("{kind: field_notes, name: notes}", "field_notes", "points").code, 0);
  const Table bins(*folder_ / "points/notes/bins.csv"), points(*folder_ / "points/notes/g_points.csv");
  ASSERT_EQ(points.rows.size(), bins.rows.size());
  for (const auto& p : points.rows) EXPECT_THAT(p, testing::ElementsAre(0, 1));
  ASSERT_EQ(render("{kind: field_notes, name: notes}", "field_notes_1.3", "older").code, 0);
  EXPECT_EQ(read_text(*folder_ / "older/notes/bins.csv"), read_text(*folder_ / "points/notes/bins.csv"));
  EXPECT_FALSE(file_exists(*folder_ / "older/notes/g_points.csv"));
}

TEST_F(Plugin, ChosenBinsCountInTheirBandsToo) {
  const CommandResult r = render("{kind: field_notes, name: notes, step_um: 0.01}", "field_notes", "chosen");
  ASSERT_EQ(r.code, 0) << r.err;
  const Table bins(*folder_ / "chosen/notes/bins.csv");
  const std::vector<double> image = EnviImage(*folder_ / "chosen/notes.img").read_all();
  for (size_t b = 0; b < 2; ++b) {
    double all = 0, weighed = 0;
    for (const auto& bin : bins.rows) all += bin[2 + b], weighed += bin[2 + b] * square_of(0.5 * (bin[0] + bin[1]));
    EXPECT_NEAR(all, 1, 1e-12);
    EXPECT_NEAR(image.at(b) / 0.5, weighed, 1e-6);
  }
}

TEST_F(Plugin, SeesErrorsAndFlagsOfItsPixels) {
  // Under a bright lamp, with one faulty pixel.
  const CommandResult r = render(
      "{kind: field_notes, name: notes, faulty: 5}]\nlamps: [{kind: point, intensity: 5, positions_m: [[2, 2, 1]]}",
      "field_notes", "flags");
  ASSERT_EQ(r.code, 0) << r.err;
  const Table pixels(*folder_ / "flags/notes/pixels.csv");
  ASSERT_EQ(pixels.rows.size(), 16u);
  const std::vector<double> image = EnviImage(*folder_ / "flags/notes.img").read_all(),
                            error = EnviImage(*folder_ / "flags/notes_error.img").read_all(),
                            quality = EnviImage(*folder_ / "flags/notes_quality.img").read_all();
  for (size_t p = 0; p < 16; ++p) {
    EXPECT_EQ(pixels.rows[p][1], quality[p]);
    EXPECT_EQ((static_cast<int>(quality[p]) & quality_failures) != 0, p == 5) << p;
    for (size_t b = 0; b < 2; ++b) {
      EXPECT_FLOAT_EQ(static_cast<float>(pixels.rows[p][2 + 2 * b]), static_cast<float>(image[2 * p + b]));
      EXPECT_FLOAT_EQ(static_cast<float>(pixels.rows[p][3 + 2 * b]), static_cast<float>(error[2 * p + b]));
      EXPECT_GT(error[2 * p + b], 0);
    }
  }
}

TEST_F(Plugin, KnowsPlaceTimeAndRun) {
  write_file(*folder_ / "placed.yaml",
             std::string_view("scene: 1\norigin: {latitude_deg: 48.2, longitude_deg: 11.6, height_m: 500}\nmaterials: "
                              "{grey: {model: lambert, reflectance: 0.5}}\nobjects: {p: {plane: {width: 0, depth: 0}, "
                              "material: grey}}\nworld: [{place: p}]\n"));
  write_file(*folder_ / "placed_sim.yaml",
             std::string_view("scene: placed.h5\nseed: 77\nepoch: 2026-06-21T10:30:00Z\nsky: {radiance: 1}\nsensors: "
                              "[{kind: field_notes, name: notes}]\n"));
  const CommandResult r = run_command("cd '" + folder_->path() +
                                      "' && " SUITE_BIN_DIR "/scene-prep placed.yaml -o placed.h5 -q && " SUITE_BIN_DIR
                                      "/dirsig-render placed_sim.yaml -o placed -q --plugin build/libfield_notes.so");
  ASSERT_EQ(r.code, 0) << r.err;
  const std::string text = read_text(*folder_ / "placed/notes/where.txt");
  EXPECT_THAT(text, HasSubstr("second 0: 2026-06-21T10:30:00"));
  EXPECT_THAT(text, HasSubstr("second 60: 2026-06-21T10:31:00"));
  EXPECT_THAT(text, HasSubstr("seed: 77\n"));
  EXPECT_THAT(text, HasSubstr("name: notes\nfolder: placed/notes\n"));
  EXPECT_THAT(text, HasSubstr("dirsig-render placed_sim.yaml"));
  double latitude = 0, longitude = 0, height = 0;
  ASSERT_EQ(std::sscanf(text.c_str(), "origin: %lf,%lf,%lf", &latitude, &longitude, &height), 3) << text;
  EXPECT_EQ(latitude, 48.2);
  EXPECT_EQ(longitude, 11.6);
  Vec3 east;
  ASSERT_EQ(std::sscanf(text.substr(text.find("1 km")).c_str(), "1 km east: %lf,%lf,%lf", &east.x, &east.y, &east.z),
            3);
  const Vec3 expected = SceneFrame({latitude, longitude, height}).ecef_from_enu({1000, 0, 0});
  EXPECT_LT(length(east - expected), 1e-6);
  // Without a place and a clock nothing is made up.
  ASSERT_EQ(render("{kind: field_notes, name: notes}", "field_notes", "nowhere").code, 0);
  EXPECT_THAT(read_text(*folder_ / "nowhere/notes/where.txt"), testing::StartsWith("origin:\nsecond 0: \n"));
}

TEST_F(Plugin, WritesFilesWholeOrNotAtAll) {
  CommandResult r = render("{kind: field_notes, name: notes, file: ../bins.csv}", "field_notes", "up");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("cannot write a file named '../bins.csv'"));
  EXPECT_FALSE(file_exists(*folder_ / "up/bins.csv"));
  // A folder stands where the file is to be: told with its path, and nothing is left beside it.
  ASSERT_EQ(run_command("mkdir -p '" + (*folder_ / "taken/notes/bins.csv") + "'").code, 0);
  r = render("{kind: field_notes, name: notes}", "field_notes", "taken");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("taken/notes/bins.csv"));
  EXPECT_EQ(run_command("ls -A '" + (*folder_ / "taken/notes") + "'").out, "bins.csv\n");
  // A study keeps no files of sensors.
  write_file(*folder_ / "study.yaml",
             std::string_view("scene: scene.h5\nsky: {radiance: 1}\nsensors: [{kind: field_notes, name: notes}]\n"));
  r = run_command("cd '" + folder_->path() +
                  "' && " SUITE_BIN_DIR
                  "/dirsig-render study.yaml --study studied -q --study-budgets 4,8 --study-seeds 2 --plugin "
                  "build/libfield_notes.so");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_FALSE(file_exists(*folder_ / "studied/notes/bins.csv"));
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
}  // namespace suite::plugin_test
