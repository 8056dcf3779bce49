// Old names of keys, options and parts (base/renamed.h): each gives the bytes of the new name and one warning with a
// code that names the new one; both at once are refused with their places. The page of old names is the table.
#include "base/renamed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>

#include "formats/hdf5/h5.h"
#include "support/las_kit.h"
#include "support/programs_kit.h"
#include "support/tape7_kit.h"

namespace suite::renamed_test {
namespace {

using testing::HasSubstr;
using testing::Not;

// A text with NAME where the key stands; `value`: another one for both at once.
struct Row {
  const char *old_name, *new_name;
  std::string text;
  const char* value;
};

const std::string kSun = "sun: {direction: {zenith_deg: 40, azimuth_deg: 90}, irradiance: 1000, half_angle_deg: 0.5}\n";
std::string camera(const std::string& more = {}, const std::string& band = "center_um: 0.55, fwhm_um: 0.02",
                   const std::string& position = "[0, -20, 30]") {
  return "sensors:\n  - {kind: frame_camera, name: eye, columns: 8, rows: 6, pitch_um: 100, focal_length_mm: 50, "
         "position_m: " +
         position + ", look_at_m: [0, 0, 0], paths: 4, bands: [{name: b, " + band + ", shape: rectangular}]" + more +
         "}\n";
}
std::string air(const std::string& keys) { return "atmosphere: " + keys + "\n" + kSun + camera(); }
std::string heat(const std::string& keys) {
  return "epoch: 2001-07-14T07:00:00Z\nweather: {file: denver.epw, year: 2001}\n"
         "heat: {elements: 12, step_s: 1800" +
         keys + "}\n" + camera(", time_s: 43200", "center_um: 10, fwhm_um: 1");
}
std::string tables(const std::string& keys) {
  return "atmosphere: {scene_height_m: 0, " + keys + "}\n" +
         "sun: {direction: {zenith_deg: 40, azimuth_deg: 90}, irradiance: 1800, collimated: true}\n" +
         camera("", "center_um: 0.55, fwhm_um: 0.02", "[0, 0, 3000]");
}
std::string placed(const std::string& objects, const std::string& world) {
  return "scene: 1\norigin: {latitude_deg: 50.5, longitude_deg: 9, height_m: 100}\nmaterials: {grey: {model: lambert, "
         "reflectance: 0.3}}\nobjects: {" +
         objects + "}\nworld: [" + world + "]\n";
}

// Of simulations over `scene.h5`.
std::vector<Row> simulations() {
  const std::string gas = "heights_m: [0, 1000, 5000], gases: [{name: a, ";
  const std::string cloud = "{profile: us_standard, clouds: [{kind: water, base_m: 900, top_m: 1000, NAME: 3}]}";
  return {
      {"guide_to_gloss", "caustic_guiding", "NAME: true\n" + kSun + camera(), "false"},
      {"light_through_refraction", "manifold_nee", "NAME: false\n" + kSun + camera(), "true"},
      {"knots", "hero_wavelengths", kSun + camera(", NAME: 2"), "3"},
      {"target_k", "target_error_k", heat(", NAME: 5"), "6"},
      {"audit", "random_walks", heat(", paths: 16, NAME: 32"), "64"},
      {"leave_out_k", "influence_cutoff_k", heat(", paths: 16, NAME: 0.01"), "0.02"},
      {"intervals", "geometry_intervals", heat(", paths: 16, NAME: 3"), "4"},
      {"ride", "attached_to", "lamps: [{kind: point, NAME: yard, position_m: [0, 0, 3], intensity: 20}]\n" + camera(),
       "wall"},
      {"aerosol_depth_500", "aerosol_optical_depth_500", "sky: {kind: clear, NAME: 0.2}\n" + kSun + camera(), "0.3"},
      {"depth_550", "optical_depth_550", air(cloud), "4"},
      {"column_depth", "column_optical_depth", air("{" + gas + "NAME: 0.1, scale_height_m: 900}]}"), "0.2"},
      {"layer_depths", "layer_optical_depths", air("{" + gas + "NAME: [0.1, 0.2]}]}"), "[0.2, 0.1]"},
      {"within_deg", "angle_tolerance_deg", tables("tables: [run.tp7], NAME: 3"), "4"},
      {"within_m", "height_tolerance_m", tables("tables: [run.tp7], angle_tolerance_deg: 3, NAME: 200"), "300"},
      {"longest_m", "max_range_m", tables("tables: [{file: curves.hdf, NAME: 5000}]"), "6000"}};
}
// Of scenes.
std::vector<Row> scenes() {
  return {
      {"longest_m", "max_edge_m", placed("ground: {points: c.las, material: grey, NAME: 30}", "{place: ground}"), "40"},
      {"turn", "random_heading",
       placed("field: {plane: {width: 9, depth: 9}, material: grey}, hill: {obj: hill.obj, material: grey}, stone: "
              "{obj: stone.obj, material: grey}",
              "{place: hill}, {place: stone, on: hill, scatter: {density_per_m2: 0.2, NAME: false}}"),
       "true"}};
}

// Parts of the renderer, by both names.
constexpr std::pair<const char*, const char*> kParts[] = {
    {"MNEE", "manifold"},         {"refracted light", "manifold"},      {"multi-vertex NEE", "volume_chains"},
    {"splitting", "side_vertex"}, {"caustic guiding", "caustic_guide"}, {"gloss guide", "caustic_guide"}};

std::string with_name(const std::string& text, const std::string& name) {
  return std::regex_replace(text, std::regex("NAME"), name);
}
// The text with both names.
std::string with_both(const Row& r) {
  return std::regex_replace(
      r.text, std::regex("NAME(: (\\[[^\\]]*\\]|[^,}\\]\n]+))"),
      std::string(r.old_name) + "$1" + (r.text.starts_with("NAME") ? "\n" : ", ") + r.new_name + ": " + r.value);
}

class Renamed : public ProgramsTest<Renamed> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    std::filesystem::copy(SUITE_SOURCE_DIR "/sample_scenes/summer_street/denver_july.epw", *folder_ / "denver.epw");
    prepare(R"(scene: 1
origin: {latitude_deg: 39.83, longitude_deg: -104.65, height_m: 1650}
materials:
  concrete:
    model: lambert
    reflectance: {points: [[0.4, 0.2], [0.7, 0.3]], outside: hold}
    thermal: {thickness_m: 0.2, density_kg_m3: 2300, specific_heat_j_kg_k: 900, conductivity_w_m_k: 1.4}
    temperature: {model: heat}
objects:
  yard: {plane: {width: 80, depth: 80}, material: concrete}
  wall: {box: {x0: -1, y0: -1, z0: 0, x1: 1, y1: 1, z1: 3}, material: concrete}
world: [{place: yard}, {place: wall}]
)");
    const auto write = [](const char* name, const std::string& text) {
      write_file(*folder_ / name, std::string_view(text));
    };
    test::MadeRun run;
    run.row = [](double) { return test::MadeRow{0.6, 0, 2.4e-8, 0.42, 5e-6}; };
    write("run.tp7", test::tape7_text({run}));
    write("hill.obj", "v -9 -9 0\nv 9 -9 1\nv 9 9 0\nv -9 9 2\nf 1 2 3\nf 1 3 4\n");
    write("stone.obj", "v -0.5 0 0\nv 0.3 0 0\nv 0 0.4 0\nv 0 0.1 0.5\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    std::vector<test::LasPoint> points;
    for (int i = 0; i < 36; ++i)
      points.push_back(
          {500000 + 12.0 * (i % 6) + (i % 6 == 5 ? 60 : 0), 5600000 + 12.0 * (i / 6), 100 + 0.7 * (i % 5)});
    write("c.las", test::las(points));
    h5::Writer writer(*folder_ / "curves.hdf", *folder_ / "curves.hdf");
    writer.put("/SpectralSamples", std::vector<float>{0.4f, 0.5f, 0.6f}, "1", 3);
    writer.put("/SolarDeclinationSamples", std::vector<float>{10, 70}, "1");
    std::vector<float> values;
    for (int angle = 0; angle < 2; ++angle)
      for (const float v : {0.1f, 1e-9f, 1e-4f, 0.02f}) values.insert(values.end(), 3, v);
    writer.put("/Conditions/clear", values, "1", 3);
    writer.close();
  }
  static CommandResult simulate(const std::string& text, const std::string& options = {}) {
    std::filesystem::remove_all(*folder_ / "out");
    write_file(*folder_ / "sim.yaml", std::string_view("scene: scene.h5\n" + text));
    return run("dirsig-render sim.yaml -o out -q " + options);
  }
  // Every result but the log, which has the warning, and the page of temperatures, which states seconds.
  static std::map<std::string, std::string> results() {
    std::map<std::string, std::string> all;
    for (const auto& file : std::filesystem::directory_iterator(*folder_ / "out"))
      if (const std::string name = file.path().filename(); name != "render.json" && name != "heat.html")
        all[name] = read_text(file.path(), 1 << 26);
    return all;
  }
  static CommandResult make_scene(const std::string& text, const std::string& options = {}) {
    write_file(*folder_ / "made.yaml", std::string_view(text));
    return run("scene-prep made.yaml --force -o made.h5 " + options);
  }
  static std::string geometry() {
    std::filesystem::remove(*folder_ / "made.obj");
    EXPECT_EQ(run("scene-prep made.h5 --export-obj made.obj -q").code, 0);
    return read_text(*folder_ / "made.obj", 1 << 26);
  }
};

size_t count_of(const std::string& text, const std::string& what) {
  size_t n = 0;
  for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++n;
  return n;
}
std::string now(const Row& r) { return strf("'%s' is now '%s'", r.old_name, r.new_name); }

TEST_F(Renamed, KeysOfSimulations) {
  for (const Row& r : simulations()) {
    const CommandResult old = simulate(with_name(r.text, r.old_name));
    ASSERT_EQ(old.code, 0) << r.old_name << old.err;
    EXPECT_EQ(count_of(old.err, "[DR904]"), 1u) << old.err;
    EXPECT_THAT(old.err, HasSubstr(now(r)));
    EXPECT_THAT(old.err, HasSubstr("warning: sim.yaml:"));
    const auto before = results();
    const CommandResult made = simulate(with_name(r.text, r.new_name));
    ASSERT_EQ(made.code, 0) << r.new_name << made.err;
    EXPECT_THAT(made.err, Not(HasSubstr("DR904")));
    const auto after = results();
    EXPECT_EQ(before.size(), after.size());
    EXPECT_GE(before.size(), 5u);
    for (const auto& [name, bytes] : before) EXPECT_TRUE(after.at(name) == bytes) << r.old_name << ": " << name;
    const CommandResult both = simulate(with_both(r));
    EXPECT_EQ(both.code, 1) << r.old_name;
    EXPECT_THAT(both.err, HasSubstr(strf("'%s' is the old name of '%s', which is given too", r.old_name, r.new_name)));
    EXPECT_TRUE(std::regex_search(both.err, std::regex("^sim.yaml:[0-9]+:[0-9]+: error"))) << both.err;
  }
}

TEST_F(Renamed, KeysOfScenes) {
  for (const Row& r : scenes()) {
    const CommandResult old = make_scene(with_name(r.text, r.old_name));
    ASSERT_EQ(old.code, 0) << old.err;
    EXPECT_EQ(count_of(old.out, "[SP004]"), 1u) << old.out;
    EXPECT_THAT(old.out, HasSubstr(now(r)));
    EXPECT_THAT(old.out, HasSubstr("made.yaml:"));
    const std::string before = geometry();
    const CommandResult made = make_scene(with_name(r.text, r.new_name));
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_THAT(made.out, Not(HasSubstr("SP004")));
    EXPECT_EQ(before, geometry());
    const CommandResult both = make_scene(with_both(r));
    EXPECT_EQ(both.code, 1);
    EXPECT_THAT(both.err, HasSubstr("is the old name of"));
    EXPECT_THAT(both.err, HasSubstr("made.yaml:"));
  }
}

TEST_F(Renamed, Options) {
  const std::string text = kSun + camera();
  const CommandResult old = simulate(text, "--kit-memory 512MiB");
  ASSERT_EQ(old.code, 0) << old.err;
  EXPECT_EQ(count_of(old.err, "[DR904]"), 1u) << old.err;
  EXPECT_THAT(old.err, HasSubstr("'--kit-memory' is now '--cache-memory'"));
  const auto before = results();
  EXPECT_THAT(simulate(text, "--cache-memory=512MiB").err, Not(HasSubstr("DR904")));
  EXPECT_EQ(simulate(text, "--cache-memory 512MiB").code, 0);
  EXPECT_TRUE(before == results());
  EXPECT_THAT(simulate(text, "--kit-memory=512MiB --mute DR904").err, Not(HasSubstr("DR904")));
  const CommandResult both = simulate(text, "--kit-memory 512MiB --cache-memory 512MiB");
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, HasSubstr("'--kit-memory' is the old name of '--cache-memory'"));
  EXPECT_THAT(run("dirsig-render --help").out, Not(HasSubstr("--kit-memory")));

  std::filesystem::copy(SUITE_SOURCE_DIR "/tests/data/dirsig", *folder_ / "dirsig",
                        std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  const auto account = [](const std::string& option) {
    const CommandResult r = run("scene-prep dirsig/plane.scene -o plane.h5 --force " + option + " plane.json");
    EXPECT_EQ(r.code, 0) << r.err;
    return std::pair{read_text(*folder_ / "plane.json", 1 << 26), count_of(r.err, "[SP004]")};
  };
  const auto [as_before, warned] = account("--account");
  const auto [as_now, silent] = account("--import-report");
  EXPECT_EQ(as_before, as_now);
  EXPECT_EQ(warned, 1u);
  EXPECT_EQ(silent, 0u);
  const CommandResult told = run("dirsig-render dirsig/plane.jsim -o jsim --account jsim.json -q");
  EXPECT_EQ(count_of(told.err, "[DR904]"), 1u) << told.err;
  EXPECT_TRUE(std::filesystem::exists(*folder_ / "jsim.json"));
}

// A setting by the old name is one, too; over a text with the new name it is refused.
TEST_F(Renamed, Settings) {
  const CommandResult r = simulate(kSun + camera(), "--set guide_to_gloss=false");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(count_of(r.err, "[DR904]"), 1u) << r.err;
  const CommandResult both = simulate("caustic_guiding: true\n" + kSun + camera(), "--set guide_to_gloss=false");
  EXPECT_EQ(both.code, 1);
  EXPECT_THAT(both.err, HasSubstr("keep 'caustic_guiding' (sim.yaml:2:1)"));
}

// Parts of `--explain`: the old name explains the new one.
TEST_F(Renamed, Parts) {
  for (const auto& [old_name, new_name] : kParts) {
    const CommandResult old = run(strf("dirsig-render --explain '%s'", old_name));
    ASSERT_EQ(old.code, 0) << old.err;
    EXPECT_EQ(count_of(old.err, "[DR904]"), 1u) << old.err;
    EXPECT_THAT(old.err, HasSubstr(strf("the part '%s' is now '%s'", old_name, new_name)));
    const CommandResult made = run(strf("dirsig-render --explain '%s'", new_name));
    EXPECT_EQ(made.err, "") << new_name;
    EXPECT_EQ(old.out, made.out) << old_name;
    EXPECT_THAT(made.out, testing::StartsWith(std::string(new_name) + ": "));
  }
  EXPECT_THAT(run("dirsig-render --explain MNEE --mute DR904").err, Not(HasSubstr("DR904")));
  EXPECT_EQ(run("dirsig-render --explain 'light guide'").code, 1);
}

// Every row of the table is gone through above, and stands on its page.
TEST_F(Renamed, TheTableIsWhole) {
  std::vector<std::string> known{"--kit-memory --cache-memory", "--account --import-report"}, rows;
  for (const auto& [old_name, new_name] : kParts) known.push_back(std::string(old_name) + " " + new_name);
  for (const auto& cases : {simulations(), scenes()})
    for (const Row& r : cases) known.push_back(std::string(r.old_name) + " " + r.new_name);
  std::string page;
  for (const RenamedName& row : renamed_names()) {
    rows.push_back(std::string(row.old_name) + " " + std::string(row.new_name));
    page += "| `" + std::string(row.old_name) + "` | `" + std::string(row.new_name) + "` | " + row.where + " |\n";
  }
  EXPECT_THAT(rows, testing::UnorderedElementsAreArray(known));
  EXPECT_THAT(read_text(SUITE_SOURCE_DIR "/docs/reference/renamed.md", 1 << 20),
              HasSubstr("| old name | new name | where |\n|---|---|---|\n" + page));
}

}  // namespace
}  // namespace suite::renamed_test
