// Budgets, references, folders, slabs and tables that cannot be: one clear message and exit code 1 for each, as a user
// of the programs meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "support/run_command.h"

namespace suite::evidence_input_test {
namespace {

using testing::HasSubstr;

class Evidence : public testing::Test {
 protected:
  void SetUp() override {
    write_file(folder_ / "scene.yaml",
               std::string_view("scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.5}}\nobjects: {p: {plane: "
                                "{width: 0, depth: 0}, material: grey}}\nworld: [{place: p}]\n"));
    write_file(folder_ / "sim.yaml",
               std::string_view(
                   "scene: scene.h5\nsky: {radiance: 1}\nsensors:\n  - {kind: orthographic, name: map, columns: "
                   "4, rows: 4, gsd_m: 1, center_m: [0, 0], time_s: 20, paths: 4, bands: [{name: a, center_um: 10, "
                   "fwhm_um: 0.5}, {name: b, center_um: 11, fwhm_um: 0.5}]}\n"));
    ASSERT_EQ(run("scene-prep scene.yaml -o scene.h5").code, 0);
  }
  CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/" + command + " -q");
  }
  void refused(const std::string& command, const std::string& says) {
    const CommandResult r = run(command);
    EXPECT_EQ(r.code, 1) << command;
    EXPECT_THAT(r.err, HasSubstr(says)) << command;
    const size_t first = r.err.find("error");
    EXPECT_NE(first, std::string::npos);
    EXPECT_EQ(r.err.find("error:", first + 6), std::string::npos) << "one message: " << r.err;
  }
  // A scene whose material has these thermal keys.
  void scene(const std::string& material) {
    write_file(folder_ / "warm.yaml",
               std::string_view("scene: 1\nmaterials:\n  roof: {model: lambert, reflectance: 0.1, " + material +
                                "}\nobjects: {p: {plane: {width: 0, depth: 0}, material: "
                                "roof}}\nworld: [{place: p}]\n"));
  }
  TempFolder folder_;
};

TEST_F(Evidence, BudgetsOfNothing) {
  for (const char* option : {"--paths 0", "--time 0s"}) {
    const CommandResult r = run(std::string("dirsig-render sim.yaml ") + option);
    EXPECT_EQ(r.code, 2) << "bad usage, as other budgets that cannot be";
    EXPECT_THAT(r.err, HasSubstr("a budget of nothing gives nothing"));
  }
  refused("dirsig-render sim.yaml --study s --study-budgets 0", "gives nothing to study");
  refused("dirsig-render sim.yaml --study s --study-budgets 0s", "gives nothing to study");
  EXPECT_FALSE(file_exists(folder_ / "out/map.img"));
}

// Light, and the bins it is carried in, follow from a file that the simulation only names.
TEST_F(Evidence, StatesOfOtherFiles) {
  const std::string sim = read_text(folder_ / "sim.yaml", 10000);
  std::string named = sim;
  named.replace(named.find("radiance: 1"), 11, "radiance: sky.txt");
  write_file(folder_ / "named.yaml", named);
  write_file(folder_ / "sky.txt", std::string_view("8 1\n14 1\n"));
  ASSERT_EQ(run("dirsig-render named.yaml --state -o out").code, 0);
  ASSERT_EQ(run("dirsig-render named.yaml --more 4 -o out").code, 0);
  write_file(folder_ / "sky.txt", std::string_view("8 1\n9.9 1\n10 5\n10.1 1\n14 1\n"));
  refused("dirsig-render named.yaml --more 4 -o out", "files named");
  write_file(folder_ / "sky.txt", std::string_view("8 1\n14 1\n"));
  EXPECT_EQ(run("dirsig-render named.yaml --more 4 -o out").code, 0);
}

TEST_F(Evidence, FoldersThatCannotBeWritten) {
  refused("dirsig-render sim.yaml -o /dev/null/x", "/dev/null/x: error: folder cannot be made");
  refused("dirsig-render sim.yaml --study /dev/null/x", "/dev/null/x: error: folder cannot be made");
  refused("scene-prep scene.yaml --force -o /dev/null/x.h5", "/dev/null/x.h5");
}

TEST_F(Evidence, ReferencesOfOtherSizesAndBands) {
  ASSERT_EQ(run("dirsig-render sim.yaml -o one").code, 0);
  std::string text = read_text(folder_ / "sim.yaml");
  const size_t second = text.find(", {name: b");
  write_file(folder_ / "fewer.yaml", std::string_view(text.substr(0, second) + "]}\n"));
  refused("dirsig-render fewer.yaml --study s1 --reference one/map.img",
          "the reference has 2 bands, the simulation gives 1");
  text.replace(text.find("rows: 4"), 7, "rows: 5");
  write_file(folder_ / "larger.yaml", std::string_view(text));
  refused("dirsig-render larger.yaml --study s2 --reference one/map.img",
          "the reference has 4 x 4 pixels, the simulation gives 20");
}

TEST_F(Evidence, SlabsWithoutSubstance) {
  const std::string good = "conductivity_w_m_k: 1, density_kg_m3: 1000, specific_heat_j_kg_k: 800, thickness_m: 0.1";
  auto with = [&](const std::string& key, const std::string& value) {
    std::string text = good;
    const size_t at = text.find(key), end = std::min(text.find(',', at), text.size());
    return text.replace(at, end - at, key + ": " + value);
  };
  for (const char* key : {"conductivity_w_m_k", "density_kg_m3", "specific_heat_j_kg_k", "thickness_m"})
    for (const char* value : {"0", "-1", ".nan"}) {
      scene("temperature: {model: slab, start_s: 0, initial_k: 290}, thermal: {" + with(key, value) + "}");
      const CommandResult flat = run("scene-prep warm.yaml -o warm.h5");
      EXPECT_EQ(flat.code, 1) << key << value;
      EXPECT_THAT(flat.err, HasSubstr("warm.yaml:3:")) << key << value;
      scene("temperature: {model: slab, start_s: 0, initial_k: 290}, thermal: {layers: [{" + with(key, value) + "}]}");
      const CommandResult layered = run("scene-prep warm.yaml -o warm.h5");
      EXPECT_EQ(layered.code, 1) << key << value;
      EXPECT_THAT(layered.err, HasSubstr("warm.yaml:3:")) << key << value;
      EXPECT_FALSE(file_exists(folder_ / "warm.h5"));
    }
}

TEST_F(Evidence, TablesThatDoNotReachTheTimeAsked) {
  scene("temperature: {table: [[0, 290], [10, 300]]}");
  ASSERT_EQ(run("scene-prep warm.yaml -o scene.h5 --force").code, 0);
  refused("dirsig-render sim.yaml",
          "material 'roof': its temperatures are given from 0 to 10 s, 20 to 20 s are simulated");
  EXPECT_FALSE(file_exists(folder_ / "out/map.img"));
}

}  // namespace
}  // namespace suite::evidence_input_test
