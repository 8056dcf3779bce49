// What only the libraries find, told with the file, the line and, where one is meant, the band; by a run and by
// --dry-run alike. These faults were told without a place, or by the run alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "support/programs_kit.h"

namespace suite::places_of_faults_test {
namespace {

using testing::HasSubstr;

const char* const kScene = R"(scene: 1
origin: {latitude_deg: 49.4, longitude_deg: 8.7, height_m: 100}
materials:
  grey: {model: lambert, reflectance: 0.2}
objects:
  floor: {plane: {width: 20, depth: 20}, material: grey}
  block: {box: {x0: -1, y0: -1, z0: 0, x1: 1, y1: 1, z1: 1}, material: grey}
world:
  - {place: floor}
  - {place: block, translate: [0, 0, 2]}
)";
const char* const kSimulation = R"(scene: scene.h5
sun: {direction: {zenith_deg: 30, azimuth_deg: 135}}
sensors:
  - kind: frame_camera
    name: eye
    position_m: [1, 0, 50]
    look_at_m: [0, 0, 0]
    focal_length_mm: 35
    columns: 4
    rows: 4
    pitch_um: 100
    paths: 4
    bands: [{name: green, center_um: 0.55, fwhm_um: 0.01}]
)";
const std::string kWarm = "sensors.0.bands=[{name: warm, center_um: 10, fwhm_um: 1}]";
const std::string kLayers =
    "materials.grey.thermal={layers: [{thickness_m: 0.1, density_kg_m3: 2000, specific_heat_j_kg_k: 900, "
    "conductivity_w_m_k: 1}]}";
const std::string kMoving =
    "world.1.motion={kind: keyframes, keys: [{time_s: 0, position_m: [0, 0, 3]}, {time_s: 5, position_m: [1, 0, 3]}]}";

struct Fault {
  const char* name;
  std::vector<std::string> scene, simulation;  // settings
  std::vector<const char*> told;
};

class PlacesOfFaults : public ProgramsTest<PlacesOfFaults> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    prepare(kScene);
    write_file(*folder_ / "sim.yaml", std::string_view(kSimulation));
    write_file(*folder_ / "short.txt", std::string_view("0.748 0.1\n1.2 0.2\n2.5 0.3\n"));
    write_file(*folder_ / "a_file", std::string_view("no folder\n"));
  }
  static std::string sets(const std::vector<std::string>& all) {
    std::string text;
    for (const std::string& one : all) text += " --set '" + one + "'";
    return text;
  }
  static void check(const Fault& f) {
    std::string options = sets(f.simulation);
    if (!f.scene.empty()) {
      const CommandResult made = run("scene-prep scene.yaml -o other.h5 -q" + sets(f.scene));
      ASSERT_EQ(made.code, 0) << f.name << made.out << made.err;
      options += " --set scene=other.h5";
    }
    for (const char* how : {"--dry-run", ""}) {
      const CommandResult r = run(std::string("dirsig-render sim.yaml -o out -q ") + how + options);
      EXPECT_EQ(r.code, 1) << f.name << ' ' << how << r.out << r.err;
      for (const char* told : f.told) EXPECT_THAT(r.err, HasSubstr(told)) << f.name << ' ' << how;
      EXPECT_FALSE(file_exists(*folder_ / "out/eye.img")) << f.name << ' ' << how;
    }
  }
};

TEST_F(PlacesOfFaults, OfSensors) {
  const char* const here = "sim.yaml:4:5: error: ";
  const std::vector<Fault> table{
      {"too fast",
       {"world.1.motion={kind: spin, axis: [0, 0, 1], rate_deg_s: 3.6e9, position_m: [0, 0, 3]}"},
       {"sensors.0.integration_time_s=10"},
       {here, "sensor 'eye'", "the motion of 'block'", "more than a million steps", "a shorter exposure"}},
      {"no tags", {}, {"sensors.0.truth=[abundance]"}, {here, "the truth 'abundance' needs a scene with tags"}},
      {"no origin",
       {"origin=null"},
       {"sensors.0.truth=[geodetic]"},
       {"--set sensors.0.truth: error: ", "the truth 'geodetic' needs a scene with"}},
      {"channel", {}, {"sensors.0.channels=[nothing]"}, {here, "unknown channel 'nothing'"}},
      {"truth", {}, {"sensors.0.truth=[nothing]"}, {"--set sensors.0.truth: error: ", "'nothing'"}},
      {"no weather",
       {kLayers, "materials.grey.temperature={model: heat}"},
       {kWarm},
       {here, "material 'grey'", "weather, which is not given"}},
      {"temperatures end",
       {"materials.grey.temperature={model: tabulated, table: [[0, 300], [10, 310]]}"},
       {kWarm, "sensors.0.time_s=50"},
       {here, "'warm'", "given from 0 to 10 s, 50 to 50 s are simulated"}},
      {"loads end",
       {kLayers,
        "materials.grey.temperature={model: slab, start_s: 0, initial_k: 300, loads: {table: [[0, "
        "500, 300, 290, 2], [3600, 600, 300, 291, 2]]}}"},
       {kWarm, "sensors.0.time_s=-50"},
       {here, "'warm'", "given from 0 to 3600 s, -50 to -50 s are simulated"}},
      {"curve too short",
       {"materials.grey.reflectance=short.txt"},
       {},
       {here, "band 'green' of sensor 'eye' reaches from", "material 'grey' has its reflectance from 0.748 to 2.5 um"}},
      {"medium too short",
       {"media={haze: {absorption: short.txt}}", "materials.grey={inside: haze}"},
       {},
       {here, "band 'green' of sensor 'eye'", "medium 'haze' has its absorption from 0.748 to 2.5 um"}},
      {"too large",
       {},
       {"sensors.0.columns=60000", "sensors.0.rows=60000"},
       {here, "the largest capture of sensor 'eye' takes", "and this machine has"}},
  };
  for (const Fault& f : table) check(f);
}

TEST_F(PlacesOfFaults, OfPeriodicScenes) {
  const auto cell = [](const char* size) { return strf("periodic={origin_m: [-10, -10], size_m: [%s]}", size); };
  const std::vector<Fault> table{
      {"wide", {}, {cell("0.01, 0.01")}, {"--set periodic: error: ", "64 times as wide as the cell"}},
      {"moving", {kMoving}, {cell("30, 30")}, {"--set periodic: error: ", "cannot hold anything that moves"}},
      {"tilted",
       {"objects.floor.plane={}", "world.0.rotate={euler_deg: [10, 0, 0]}"},
       {cell("30, 30")},
       {"--set periodic: error: ", "is not level"}},
  };
  for (const Fault& f : table) check(f);
}

// Scene preparation, of what moves too fast for the times that the text gives.
TEST_F(PlacesOfFaults, OfScenes) {
  const CommandResult r = run(
      "scene-prep scene.yaml -o fast.h5 -q --set 'times_s=[0, 1.0e7]' --set 'world.1.motion={kind: spin, axis: [0, 0, "
      "1], rate_deg_s: 3.6e9, position_m: [0, 0, 3]}'");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.out + r.err, testing::AllOf(HasSubstr("--set times_s: error: the motion of 'block'"),
                                            HasSubstr("more than a million steps")));
}

// Folders that cannot be written to are refused by --dry-run too, which leaves nothing behind.
TEST_F(PlacesOfFaults, OfFolders) {
  for (const char* how : {"--dry-run", ""})
    for (const char* folder : {"a_file", "a_file/out", "/proc/nowhere"}) {
      const CommandResult r = run(std::string("dirsig-render sim.yaml -q ") + how + " -o " + folder);
      EXPECT_EQ(r.code, 1) << folder << how;
      EXPECT_THAT(r.err, testing::AllOf(HasSubstr(folder), HasSubstr("folder"), HasSubstr("name a writable place")))
          << how;
    }
  std::filesystem::create_directory(*folder_ / "empty");
  EXPECT_EQ(run("dirsig-render sim.yaml -q --dry-run -o empty").code, 0);
  EXPECT_EQ(run("dirsig-render sim.yaml -q --dry-run -o not_yet/deeper").code, 0);
  EXPECT_TRUE(std::filesystem::is_empty(*folder_ / "empty"));
  EXPECT_FALSE(file_exists(*folder_ / "not_yet"));
}

// Steps without number: refused with how many they would be, instead of being run (tests/data/refused).
TEST_F(PlacesOfFaults, OfStepsWithoutNumber) {
  const struct {
    const char *file, *told;
  } table[] = {{"slab_period.yaml", "4.2949673e+09 s are at least 2.39e+06 steps; at most 2e+06"},
               {"slab_load.yaml", "3600 s are at least 3.6e+303 steps; at most 2e+06"}};
  for (const auto& row : table) {
    const CommandResult r = run("scene-prep " SUITE_TEST_DATA "/refused/" + std::string(row.file) + " -o slab.h5 -q");
    EXPECT_EQ(r.code, 1) << row.file;
    EXPECT_THAT(r.out + r.err,
                testing::AllOf(HasSubstr(std::string(row.file) + ":4:54: a slab's period_s"), HasSubstr(row.told)));
  }
}

// Times far from any date of the epoch's calendar.
TEST_F(PlacesOfFaults, OfTimesWithoutDate) {
  prepare(read_text(SUITE_TEST_DATA "/refused/far_time_scene.yaml"), "far");
  for (const char* time : {"1.0e18", "1.0e14"})
    for (const char* how : {"--dry-run", ""}) {
      std::filesystem::copy_file(SUITE_TEST_DATA "/refused/far_time.yaml", *folder_ / "far_time.yaml",
                                 std::filesystem::copy_options::overwrite_existing);
      std::string text = read_text(*folder_ / "far_time.yaml");
      text.replace(text.find("1.0e18"), 6, time);
      write_file(*folder_ / "far_time.yaml", std::string_view(text));
      const CommandResult r = run(std::string("dirsig-render far_time.yaml -o far -q ") + how);
      EXPECT_EQ(r.code, 1) << time << how;
      EXPECT_THAT(r.err, testing::AllOf(HasSubstr("far_time.yaml:5:116: error: "), HasSubstr("s after the epoch"),
                                        HasSubstr("outside the range of UTC here; 1972 to 2199")));
    }
}

// A body that shares its outer face with its container, both of one priority: a warning at its object.
TEST_F(PlacesOfFaults, OfSharedFaces) {
  const auto media = [](const char* priority) {
    return strf("media={water: {absorption: 1}, oil: {absorption: 2%s}}", priority);
  };
  const std::string rest =
      " --set materials.pool='{inside: water}' --set materials.drum='{inside: oil}' --set 'objects.pool={box: {x0: -5, "
      "y0: -5, z0: -2, x1: 5, y1: 5, z1: 0}, material: pool}' --set 'objects.drum={box: {x0: -1, y0: -1, z0: -1, x1: "
      "1, "
      "y1: 1, z1: 0}, material: drum}' --set 'world=[{place: pool}, {place: drum}]'";
  const auto said = [&](const char* priority) {
    const CommandResult r = run("scene-prep scene.yaml -o pool.h5 -q --set '" + media(priority) + "'" + rest);
    EXPECT_EQ(r.code, 0) << r.err;
    return r.out + r.err;
  };
  EXPECT_THAT(said(""), testing::AllOf(HasSubstr("SP610"), HasSubstr("--set objects.drum: 'drum' (medium 'oil') and "
                                                                     "'pool' (medium 'water'), both of priority 0")));
  EXPECT_EQ(said(", priority: 1").find("SP610"), std::string::npos);
}

// A key that is missing is told with what it may be.
TEST_F(PlacesOfFaults, OfMissingKeys) {
  const struct {
    const char *program, *set, *told;
  } table[] = {
      {"dirsig-render sim.yaml -o out", "sensors.0.kind=null",
       "the key 'kind' is missing; one of: frame_camera, platform, orthographic, fisheye, point, goniometer, rami"},
      {"dirsig-render sim.yaml -o out", "sensors.0.focal_length_mm=null",
       "the key 'focal_length_mm' (millimetre) is missing; give a value from"},
      {"dirsig-render sim.yaml -o out", "lamps=[{position_m: [0, 0, 9], intensity: 1}]",
       "the key 'kind' is missing; one of: point, spot, surface"},
      {"dirsig-render sim.yaml -o out", "periodic={size_m: [3, 3]}",
       "the key 'origin_m' (metre) is missing; a list of numbers"},
      {"dirsig-render sim.yaml -o out", "sensors.0.columns=null",
       "the key 'columns' is missing; give a whole number from 1 to"},
      {"scene-prep scene.yaml -o none.h5", "materials.grey={reflectance: 0.2}", "the key 'model' is missing; one of: "},
      {"scene-prep scene.yaml -o none.h5", "world.1.motion={axis: [0, 0, 1]}",
       "the key 'kind' is missing; one of: static, keyframes, straight, circle, spin, orbit, composed"},
      {"scene-prep scene.yaml -o none.h5", "origin={height_m: 8}",
       "the key 'latitude_deg' (degree) is missing; give a value from -90 to 90 degrees"},
      {"scene-prep scene.yaml -o none.h5", "world.1.motion={kind: spin, axis: [0, 0, 1], position_m: [0, 0, 3]}",
       "the key 'rate_deg_s' (degree per second) is missing; a number"},
      {"scene-prep scene.yaml -o none.h5", "maps={cover: {file: a_file}}", "the key 'type' is missing; one of: "},
  };
  for (const auto& row : table) {
    const CommandResult r = run(std::string(row.program) + " -q --set '" + row.set + "'");
    EXPECT_EQ(r.code, 1) << row.set;
    EXPECT_THAT(r.out + r.err, HasSubstr(row.told)) << row.set;
  }
  // Nearly its name is told as that.
  const CommandResult r = run("dirsig-render sim.yaml -o out -q --set sensors.0.columns=null --set sensors.0.colums=4");
  EXPECT_THAT(r.err, HasSubstr("did you mean 'columns', which is missing?"));
}

}  // namespace
}  // namespace suite::places_of_faults_test
