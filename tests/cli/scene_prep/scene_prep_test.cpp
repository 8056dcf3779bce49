#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "base/files.h"
#include "formats/raster/raster.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "optics/models.h"
#include "support/run_command.h"

namespace suite::scene_prep_test {
namespace {

using ::testing::HasSubstr;

class ScenePrep : public ::testing::Test {
 protected:
  ScenePrep() {
    write_file(folder_ / "tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_file(folder_ / "good.yaml", kGood);
  }
  CommandResult run(const std::string& arguments) {
    return run_command("cd '" + folder_.path() + "' && '" SUITE_BIN_DIR "/scene-prep' " + arguments);
  }
  static constexpr const char* kGood =
      "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}, spare: {model: lambert, reflectance: 0.2}}\n"
      "objects: {tri: {obj: tri.obj, material: grey}}\nworld: [{place: tri}]\n";
  TempFolder folder_;
};

TEST_F(ScenePrep, WritesSummarisesAndRepeats) {
  const CommandResult r = run("good.yaml -o a.h5 --report r.json");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, HasSubstr("[SP103] x1"));
  EXPECT_THAT(r.out, HasSubstr("verdict: accepted (0 errors, 1 warnings)"));
  EXPECT_THAT(read_text(folder_ / "r.json"), HasSubstr("\"code\": \"SP103\""));
  // What the steps took, as a page that needs nothing else.
  const std::string page = read_text(folder_ / "r.html");
  for (const char* part : {"<svg", "<td>read</td>", "<td>check</td>", "<td>bake</td>", "<td>write</td>", "SP103"})
    EXPECT_THAT(page, HasSubstr(part));
  EXPECT_EQ(page.find("src="), std::string::npos);
  // The library once put the time of the second into every group.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  EXPECT_EQ(run("good.yaml -o b.h5").code, 0);
  EXPECT_EQ(read_bytes(folder_ / "a.h5"), read_bytes(folder_ / "b.h5"));
  const CommandResult s = run("--summary a.h5");
  EXPECT_EQ(s.code, 0) << s.err;
  EXPECT_THAT(s.out, HasSubstr("1 with 3 vertices, 1 triangles"));
}

TEST_F(ScenePrep, SkipsWorkThatIsDone) {
  EXPECT_EQ(run("good.yaml -o a.h5").code, 0);
  const CommandResult again = run("good.yaml -o a.h5");
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.err, HasSubstr("is up to date"));
  EXPECT_THAT(run("good.yaml -o a.h5 --force").out, HasSubstr("verdict"));
  EXPECT_THAT(run("good.yaml -o a.h5 --repair").out, HasSubstr("verdict"));
  EXPECT_EQ(run("good.yaml -o a.h5").code, 0);
  write_file(folder_ / "tri.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(run("good.yaml -o a.h5").out, HasSubstr("verdict"));
  write_file(folder_ / "a.h5", "not a scene");
  EXPECT_THAT(run("good.yaml -o a.h5").out, HasSubstr("verdict"));
}

// Every file that was read counts, also those that other files bring along, and those that would be read before them.
TEST_F(ScenePrep, SkippedWorkLooksAtEveryFile) {
  const float cube[8] = {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f, 0.7f, 0.8f};
  write_file(folder_ / "c.img", std::as_bytes(std::span(cube)));
  const std::string header =
      "ENVI\nsamples = 2\nlines = 2\nbands = 2\ndata type = 4\ninterleave = bip\nbyte order = 0\nwavelength units = "
      "um\n";
  write_file(folder_ / "c.hdr", header + "wavelength = {0.5, 0.6}\n");
  const float density[2] = {1, 2};
  write_file(folder_ / "d.raw", std::as_bytes(std::span(density)));
  write_file(folder_ / "g.vox", "voxels: 1\ncells: [2, 1, 1]\ncell_m: 1\nfields: {density: {file: d.raw}}\n");
  write_file(folder_ / "all.yaml",
             "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2, maps: [cube]}}\nmedia: {fog: {absorption: "
             "0, scattering: 1}}\n"
             "maps: {cube: {type: cube, file: c.img, projection: uv}}\ngrids: {g: {voxels: g.vox, medium: "
             "fog}}\nvolumes: [{place: g}]\n"
             "objects: {tri: {obj: tri.obj, material: grey}}\nworld: [{place: tri}]\n");
  const auto prepared = [&] { return run("all.yaml -o all.h5").out.find("verdict: accepted") != std::string::npos; };
  EXPECT_TRUE(prepared());
  EXPECT_FALSE(prepared());
  write_file(folder_ / "c.hdr", header + "wavelength = {0.5, 0.7}\n");
  EXPECT_TRUE(prepared());
  EXPECT_FALSE(prepared());
  write_file(folder_ / "c.img.hdr", header + "wavelength = {0.5, 0.8}\n");  // found before the other one
  EXPECT_TRUE(prepared());
  EXPECT_FALSE(prepared());
  const float thicker[2] = {1, 3};
  write_file(folder_ / "d.raw", std::as_bytes(std::span(thicker)));
  EXPECT_TRUE(prepared());
  EXPECT_FALSE(prepared());
  // A scene that is older than the program may have been made by another one of the same version.
  std::filesystem::last_write_time(folder_ / "all.h5",
                                   std::filesystem::file_time_type::clock::now() - std::chrono::hours(24 * 365 * 20));
  EXPECT_TRUE(prepared());
  EXPECT_FALSE(prepared());
  // What is refused leaves the old scene, and says so.
  write_file(folder_ / "c.img.hdr", "ENVI\n");
  const CommandResult refused = run("all.yaml -o all.h5");
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("all.h5 is left as it was: it does not hold this scene"));
}

TEST_F(ScenePrep, ExportsThingsWhereAndWhenTheyAre) {
  write_file(folder_ / "moves.yaml",
             "scene: 1\norigin: {latitude_deg: 39, longitude_deg: -120, height_m: 0}\n"
             "materials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {tri: {obj: tri.obj, material: grey}}\n"
             "groups: {cart: [{place: tri, translate: [0, 0, 3]}]}\n"
             "world:\n"
             "  - {place: tri, motion: {kind: static, latitude_deg: 39.001, longitude_deg: -120, height_m: 10}}\n"
             "  - {place: cart, motion: {kind: static, position_m: [50, 0, 0]}}\n"
             "  - {place: tri, translate: [900, 0, 0], appears: 5}\n");
  ASSERT_EQ(run("moves.yaml -o moves.h5").code, 0);
  const CommandResult exported = run("moves.h5 --export-obj moves.obj");
  ASSERT_EQ(exported.code, 0) << exported.err;
  EXPECT_THAT(exported.err, HasSubstr("what is there at 0 s, where it is then"));
  write_file(
      folder_ / "back.yaml",
      "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {all: {obj: moves.obj}}\nworld: "
      "[{place: all}]\n");
  ASSERT_EQ(run("back.yaml -o back.h5").code, 0);
  const Scene back = read_scene(folder_ / "back.h5");
  EXPECT_EQ(back.meshes.at(0).triangle_count(), 2u);
  EXPECT_NEAR(back.bounds.high.x, 51, 1e-3);
  EXPECT_NEAR(back.bounds.low.z, 3, 1e-6);
  EXPECT_NEAR(back.bounds.high.z, 10, 0.01);
  EXPECT_NEAR(back.bounds.high.y, 111.016 + 1, 0.01);  // a thousandth of a degree of the meridian at 39 degrees
}

TEST_F(ScenePrep, AnswersQuestionsAboutAPreparedScene) {
  write_file(
      folder_ / "q.yaml",
      "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}, red: {model: lambert, reflectance: 0.3}}\n"
      "objects: {tri: {obj: tri.obj, material: grey}, ball: {sphere: {radius: 1}, material: red}}\n"
      "groups: {pair: [{place: tri}, {place: tri, translate: [2, 0, 0], scale: [-1, 1, 1]}]}\n"
      "world: [{place: pair, translate: [10, 0, 5], tag: two}, {place: ball, translate: [0, 0, 1]}]\n");
  ASSERT_EQ(run("q.yaml -o q.h5").code, 0);
  const CommandResult ray = run("q.h5 --raycast '10.2 0.2 100 0 0 -2'");
  EXPECT_EQ(ray.code, 0) << ray.err;
  EXPECT_THAT(ray.out, HasSubstr("object    tri"));
  EXPECT_THAT(
      ray.out,
      HasSubstr("material  grey\ntag       two\ndistance  95.000000 m\nplace     10.200000 0.200000 5.000000 m"));
  EXPECT_THAT(run("q.h5 --raycast '0 0 100 0 0 -1'").out, HasSubstr("material  red\ndistance  98.000000 m"));
  EXPECT_THAT(run("q.h5 --raycast '50 50 100 0 0 -1'").out, HasSubstr("nothing"));
  EXPECT_EQ(run("q.h5 --raycast '1 2 3'").code, 2);
  EXPECT_EQ(run("q.h5 --raycast '1 2 3 x 1 1'").code, 1);
  // The export read back has the same triangles, facing the same way, where they were placed.
  const CommandResult exported = run("q.h5 --export-obj out.obj");
  EXPECT_EQ(exported.code, 0);
  EXPECT_THAT(exported.err, HasSubstr("1 exact primitives were left out"));
  write_file(folder_ / "r.yaml",
             "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {all: {obj: out.obj}}\nworld: "
             "[{place: all}]\n");
  ASSERT_EQ(run("r.yaml -o r.h5").code, 0);
  const Scene back = read_scene(folder_ / "r.h5");
  EXPECT_EQ(back.meshes.at(0).triangle_count(), 2u);
  EXPECT_NEAR(back.bounds.low.x, 10, 1e-6);
  EXPECT_NEAR(back.bounds.high.x, 12, 1e-6);
  const Mesh& m = back.meshes[0];
  for (size_t t = 0; t < 2; ++t) {
    const auto p = [&](size_t k) {
      const float* q = &m.positions[3 * size_t{m.indices[3 * t + k]}];
      return Vec3{q[0], q[1], q[2]};
    };
    EXPECT_GT(cross(p(1) - p(0), p(2) - p(0)).z, 0);
  }
  EXPECT_EQ(run("q.h5 --quick-look q.png --pixels 40").code, 0);
  EXPECT_GT(file_size(folder_ / "q.png"), 100u);
  EXPECT_EQ(run("q.h5 --quick-look q.png --pixels 0").code, 2);
}

// A tower of 2 x 2 x 10 m in the corner of a yard, by name, by number, by place, from above and from the side.
TEST_F(ScenePrep, QuickLooksAtOneThing) {
  write_file(
      folder_ / "t.yaml",
      std::string_view(
          "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}, red: {model: lambert, reflectance: 0.1}}\n"
          "objects:\n  yard: {plane: {width: 200, depth: 200}, material: grey}\n"
          "  tower: {box: {x0: -1, y0: -1, z0: 0, x1: 1, y1: 1, z1: 10}, material: red}\n"
          "  sea: {plane: {}, material: grey}\n"
          "world:\n  - {place: yard}\n  - {place: tower, translate: [50, -50, 0], tag: keep}\n"
          "  - {place: sea, translate: [0, 0, -1]}\n"));
  ASSERT_EQ(run("t.yaml -o t.h5").code, 0);
  const auto look = [&](const std::string& options) {
    const CommandResult r = run("t.h5 --quick-look t.png --pixels 110 " + options);
    EXPECT_EQ(r.code, 0) << options << r.err;
    return read_raster(folder_ / "t.png");
  };
  const auto at = [](const Raster& r, uint32_t x, uint32_t y) {
    return r.values[(size_t{y} * r.width + x) * r.channels];
  };
  const Raster whole = look("");
  ASSERT_EQ(whole.width, 110u);
  const float yard = at(whole, 0, 0), tower = at(whole, 82, 82);
  ASSERT_NE(yard, tower);
  EXPECT_EQ(at(whole, 82, 28), yard) << "north is up, east is right";
  for (const char* same : {"--look-at tower", "--look-at keep", "--look-at 1"}) {
    const Raster near = look(same);
    EXPECT_EQ(at(near, 10, 10), tower) << same;
    EXPECT_EQ(at(near, 1, 1), yard) << same << ": a margin of 5 % around it";
  }
  const Raster place = look("--look-at '50 -50' --look-size 8");
  EXPECT_EQ(at(place, 55, 55), tower);
  EXPECT_EQ(at(place, 55, 38), yard) << "2 of 8 m are the tower";
  const Raster side = look("--look-at tower --look-from '180 0'");
  EXPECT_EQ(side.width, 22u) << "2 of 10 m";
  EXPECT_EQ(side.height, 110u);
  const struct {
    const char* options;
    int code;
    const char* told;
  } wrong[] = {{"--look-at towr", 1, "did you mean 'tower'"},
               {"--look-at 99", 1, "no instance 99"},
               {"--look-at sea", 1, "has no end"},
               {"--look-at '1 2'", 2, "needs a --look-size"},
               {"--look-at '1 2 3 4' --look-size 3", 2, "two or three numbers"},
               {"--look-from '10'", 2, "azimuth and an elevation"},
               {"--look-size -3", 2, "--look-size is"}};
  for (const auto& w : wrong) {
    const CommandResult r = run(std::string("t.h5 --quick-look no.png ") + w.options);
    EXPECT_EQ(r.code, w.code) << w.options;
    EXPECT_THAT(r.err, HasSubstr(w.told)) << w.options;
    EXPECT_FALSE(file_exists(folder_ / "no.png"));
  }
  EXPECT_EQ(run("t.h5 --summary --look-at tower").code, 2) << "without a quick look it would do nothing";
}

// Other values for once are options of the scene.
TEST_F(ScenePrep, SetsValues) {
  ASSERT_EQ(run("good.yaml -o s.h5").code, 0);
  EXPECT_THAT(run("good.yaml -o s.h5").err, HasSubstr("up to date"));
  const CommandResult other = run("good.yaml -o s.h5 --set name=other");
  EXPECT_EQ(other.code, 0) << other.err;
  EXPECT_EQ(other.err.find("up to date"), std::string::npos);
  EXPECT_EQ(read_scene(folder_ / "s.h5").name, "other");
  EXPECT_THAT(run("s.h5 --summary").out, HasSubstr("--set name=other"));
  const CommandResult wrong = run("good.yaml -o s.h5 --set nmae=other");
  EXPECT_EQ(wrong.code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("--set nmae"));
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'name'"));
  EXPECT_EQ(run("s.h5 --summary --set name=x").code, 2);
}

TEST_F(ScenePrep, StrictAndMute) {
  EXPECT_EQ(run("good.yaml -o a.h5 --strict").code, 1);
  EXPECT_FALSE(file_exists(folder_ / "a.h5"));
  EXPECT_EQ(run("good.yaml -o a.h5 --strict --mute SP103").code, 0);
  const CommandResult r = run("good.yaml --mute SP013");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("unknown issue code 'SP013'; did you mean"));
}

TEST_F(ScenePrep, RefusalsNameThePlaceAndLeaveNothing) {
  const struct {
    const char *name, *text, *expected;
  } cases[] = {
      {"index0",
       "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {t: {obj: zero.obj, material: "
       "grey}}\nworld: [{place: t}]\n",
       "zero.obj:4:1: vertex index 0"},
      {"gone",
       "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {t: {obj: gone.obj, material: "
       "grey}}\nworld: [{place: t}]\n",
       "gone.yaml:3:20: file 'gone.obj' no such file"},
      {"folder",
       "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {t: {obj: ., material: "
       "grey}}\nworld: [{place: t}]\n",
       "folder.yaml:3:20: file '.' is a directory"},
      {"cover",
       "scene: 1\nwindows_um: [[0.4, 3]]\nmaterials: {grey: {model: lambert, reflectance: {points: [[0.4, 0.1], [2.5, "
       "0.2]]}}}\nobjects: {t: {obj: tri.obj, material: grey}}\nworld: [{place: t}]\n",
       "reflectance is given from 0.4 to 2.5 um, the window is 0.4 to 3 um"},
      {"unknown",
       "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {t: {obj: tri.obj, material: "
       "gray}}\nworld: [{place: t}]\n",
       "unknown material 'gray'; did you mean 'grey'?"},
  };
  write_file(folder_ / "zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n");
  const size_t before = folder_.entries();
  for (const auto& c : cases) {
    write_file(folder_ / (std::string(c.name) + ".yaml"), c.text);
    const CommandResult r = run(std::string(c.name) + ".yaml -o out.h5");
    EXPECT_EQ(r.code, 1) << c.name << r.out << r.err;
    EXPECT_THAT(r.err, HasSubstr(c.expected)) << c.name;
  }
  EXPECT_EQ(folder_.entries(), before + std::size(cases));
}

TEST_F(ScenePrep, UsageAndPlaces) {
  EXPECT_EQ(run("").code, 2);
  EXPECT_EQ(run("--help").code, 0);
  EXPECT_EQ(run("--version").code, 0);
  const CommandResult r = run("--ouput x");
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, HasSubstr("did you mean '--output'?"));
  EXPECT_EQ(run("--summary a.h5 -o b.h5").code, 2);
  EXPECT_EQ(run("missing.yaml").code, 1);
  EXPECT_EQ(run("good.yaml -o good.yaml/a.h5").code, 1);
  EXPECT_EQ(run("good.yaml -o .").code, 1);
  EXPECT_THAT(run("--list-issues").out, HasSubstr("SP201"));
  EXPECT_THAT(run("--list-models").out, HasSubstr("lambert"));
  EXPECT_THAT(run("--list-phases").out, HasSubstr("rayleigh"));
  EXPECT_THAT(run("--list-temperatures").out, HasSubstr("slab"));
  EXPECT_THAT(run("--list-importers").out, HasSubstr("scene_text"));
  write_file(folder_ / "picture.png", std::string_view("\x89PNG\0\0", 6));
  const CommandResult picture = run("picture.png");
  EXPECT_EQ(picture.code, 1);
  EXPECT_THAT(picture.err,
              HasSubstr("picture.png: error: is nothing that a scene can be made from; known: a scene of DIRSIG"));
}

TEST_F(ScenePrep, CityAndForestInSmall) {
  if (run_command("python3 --version").code != 0) GTEST_SKIP() << "needs python3 to generate the scene";
  const std::string generator = SUITE_SOURCE_DIR "/sample_scenes/city_forest/make_scene.py";
  ASSERT_EQ(run_command("python3 '" + generator + "' '" + folder_.path() + "/city' 4 20 100").code, 0);
  const CommandResult r = run("city/scene.yaml -o city.h5 --strict --mute SP103");
  ASSERT_EQ(r.code, 0) << r.out << r.err;
  const Scene s = read_scene(folder_ / "city.h5");
  EXPECT_EQ(s.groups.at(0).placements.size(), 103u);
  EXPECT_EQ(s.materials.size(), 43u);
  EXPECT_EQ(s.meshes.at(1).triangle_count(), 800u);
}

TEST_F(ScenePrep, FitsSayWhatHoldsBeyondTheirWavelengths) {
  // Regression: a fit in three colours was taken for the whole spectrum without a word.
  const std::string fit = "'" SUITE_BIN_DIR "/sqt-fit' -q --views 3 --order 4 -o '" + folder_.path() + "/grey.sqt' ";
  ASSERT_EQ(run_command(fit + "--model lambert:reflectance=0.3").code, 0);
  const auto scene = [&](const std::string& surface) {
    std::string text = kGood;
    text.replace(text.find("model: lambert"), 32, surface);
    write_file(folder_ / "fit.yaml", text + "windows_um: [[0.5, 0.9]]\n");
    return run("fit.yaml -o fit.h5");
  };
  const CommandResult r = scene("model: sqt, file: grey.sqt");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("SP104"));
  EXPECT_THAT(r.err, HasSubstr("'grey.sqt' stands for 0.5225 to 0.5775 um, the window is 0.5 to 0.9 um"));
  EXPECT_THAT(r.err, HasSubstr("fit.yaml:2"));
  EXPECT_EQ(scene("model: sqt, file: grey.sqt, outside: error").code, 1);
  EXPECT_EQ(scene("model: sqt, file: grey.sqt, outside: hold").code, 0);
  EXPECT_EQ(scene("model: sqt, file: {file: grey.sqt, outside: zero}").code, 0);
  EXPECT_EQ(scene("model: sqt, file: {file: grey.sqt, outside: clamp}").code, 1);
}

TEST_F(ScenePrep, CalibrationRange) {
  // Everything but the measured panel, whose SQT another tool makes.
  const std::string scene = SUITE_SOURCE_DIR "/sample_scenes/calibration_range";
  std::string text = read_text(scene + "/scene.yaml");
  const std::string measured = "model: sqt, file: satin.sqt, outside: hold";
  text.replace(text.find(measured), measured.size(), "model: lambert, reflectance: 0.3");
  write_file(folder_ / "range.yaml", text);
  const CommandResult r = run("range.yaml -o range.h5 --strict --path '" + scene + "'");
  ASSERT_EQ(r.code, 0) << r.out << r.err;
  const Scene s = read_scene(folder_ / "range.h5");
  // Sample (45, 138) of the raster is the origin: 127 m above a geoid 48 m above the ellipsoid, as is the origin's
  // height.
  for (const Placement& p : s.groups.at(0).placements)
    if (p.tag != kNone && s.tags[p.tag].rfind("panel", 0) == 0) {
      EXPECT_NEAR(p.to_parent.b.z, 0.5, 1.5);
    }
  EXPECT_EQ(s.class_maps.size(), 1u);
  EXPECT_GT(s.bounds.size().x, 4900);
}

}  // namespace
}  // namespace suite::scene_prep_test
