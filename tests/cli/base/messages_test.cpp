// Mistakes that people make, each beside what they are told: the place, the true cause and the cure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/files.h"
#include "support/run_command.h"

namespace suite::messages_test {
namespace {

using testing::HasSubstr;

const std::string kScene =
    "scene: 1\norigin: {latitude_deg: 49.4, longitude_deg: 8.7, height_m: 100}\nwindows_um: [[0.4, 0.9]]\n"
    "materials:\n  grey: {model: lambert, reflectance: 0.2}\n"
    "objects:\n  floor: {plane: {width: 20, depth: 20}, material: grey}\n  ball: {sphere: {radius: 1}, material: "
    "grey}\n"
    "world:\n  - {place: floor}\n  - {place: ball, translate: [0, 0, 2]}\n";
const std::string kSimulation =
    "scene: scene.h5\nsun: {direction: {zenith_deg: 30, azimuth_deg: 135}}\nsensors:\n"
    "  - kind: frame_camera\n    name: eye\n    position_m: [1, 0, 50]\n    look_at_m: [0, 0, 0]\n"
    "    focal_length_mm: 35\n    columns: 4\n    rows: 4\n    pitch_um: 100\n    paths: 4\n"
    "    bands: [{name: green, center_um: 0.55, fwhm_um: 0.01}]\n";

struct Mistake {
  const char* name;
  const char *right, *wrong;  // what is replaced in the text, and by what
  std::vector<const char*> told;
  bool accepted = false;  // with a warning
};

// The message points with a caret at the wrong place, which is where `wrong` stands, or near it.
std::string replaced(std::string text, const Mistake& m) {
  const size_t at = text.find(m.right);
  if (at == std::string::npos) throw std::logic_error(m.name);
  return text.replace(at, std::string(m.right).size(), m.wrong);
}

class Messages : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    write("nanometres.txt", "400 0.1\n500 0.2\n900 0.3\n");
    write("short.txt", "0.748 0.1\n1.2 0.2\n2.5 0.3\n");
    write("leaf.obj",
          "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nvn 0 0.6 0.8\nvn 0 0.8 -0.6\nf 1//1 2//1 3//1\nf 1//1 2//1 3//1\n"
          "f 1//2 2//2 3//3\n");
    write("measured.bsdf", "tensor_file and so on");
    write("scene.yaml", kScene);
    ASSERT_EQ(run("scene-prep scene.yaml -o scene.h5 -q").code, 0);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static void write(const std::string& name, const std::string& text) {
    write_file(*folder_ / name, std::string_view(text));
  }
  static CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_->path() + "' && " SUITE_BIN_DIR "/" + command);
  }
  static void check(const Mistake& m, const CommandResult& r) {
    EXPECT_EQ(r.code, m.accepted ? 0 : 1) << m.name;
    for (const char* told : m.told) EXPECT_THAT(r.out + r.err, HasSubstr(told)) << m.name;
  }
  static TempFolder* folder_;
};
TempFolder* Messages::folder_ = nullptr;

TEST_F(Messages, OfScenes) {
  const std::vector<Mistake> table{
      {"misspelt key", "reflectance:", "reflectence:", {"5:26", "'reflectence'", "did you mean 'reflectance'"}},
      {"tab", "  grey:", "\tgrey:", {"5:1", "tab", "spaces"}},
      {"window in nm", "[[0.4, 0.9]]", "[[400, 900]]", {"3:14", "in nanometres? then 0.4 to 0.9 um"}},
      {"curve in nm",
       "reflectance: 0.2",
       "reflectance: nanometres.txt",
       {"SP104", "in nanometres? then 0.4 to 0.9 um"}},
      {"curve in nm that is held",
       "reflectance: 0.2",
       "reflectance: {file: nanometres.txt, outside: hold}",
       {"SP110", "in nanometres? then 0.4 to 0.9 um", "wavelength_nm"},
       true},
      {"curve too short", "reflectance: 0.2", "reflectance: short.txt", {"SP104", "from 0.748 to 2.5 um"}},
      {"on what is no terrain", "translate: [0, 0, 2]", "on: floor", {"11:23", "'floor' is no terrain", "give z"}},
      {"Celsius", "reflectance: 0.2", "reflectance: 0.2, temperature_k: 25", {"SP107", "298.15 K"}, true},
      {"measurement as a fit",
       "model: lambert, reflectance: 0.2",
       "model: sqt, file: measured.bsdf",
       {"5:28", "no SQT file", "sqt-fit measured.bsdf -o measured.sqt"}},
      {"leaf normals",
       "{sphere: {radius: 1}",
       "{obj: leaf.obj",
       {"SP311] x3", "leaf.obj:7: 2 triangles whose normals all do", "leaf.obj:9: 1 triangles some of whose normals do",
        "the worst by 127 degrees"},
       true},
      {"absurd motion",
       "translate: [0, 0, 2]",
       "motion: {kind: keyframes, keys: [{time_s: 0, position_m: [0, 0, 3]}, {time_s: 5, position_m: [1.0e18, 0, 3]}]}",
       {"11:", "1e+18 m away", "1e+13 m"}},
  };
  for (const Mistake& m : table) {
    write("wrong.yaml", replaced(kScene, m));
    check(m, run("scene-prep wrong.yaml -o wrong.h5"));
  }
}

TEST_F(Messages, OfSimulations) {
  const std::vector<Mistake> table{
      {"band in nm", "center_um: 0.55, fwhm_um: 0.01", "center_um: 550, fwhm_um: 10", {"13:", "then 0.55 um"}},
      {"geodetic keys",
       "position_m: [1, 0, 50]",
       "position: {latitude_deg: 49.4, longitude_deg: 8.7, height_m: 150}",
       {"6:5", "no geodetic place", "kind: platform"}},
      {"scene text for a scene",
       "scene.h5",
       "scene.yaml",
       {"1:8", "a prepared scene (.h5)", "scene-prep scene.yaml -o scene.h5"}},
      {"sunlight too short",
       "135}}",
       "135}, irradiance: short.txt}",
       {"2:66", "irradiance is given from 0.748 to 2.5 um",
        "band 'green' of sensor 'eye' (line 4) reaches from 0.5318"}},
      {"beyond our sunlight",
       "center_um: 0.55, fwhm_um: 0.01",
       "center_um: 0.2, fwhm_um: 0.01",
       {"2:6: ", "the builtin spectrum of the sun is given from 0.202 to 1000 um",
        "band 'green' of sensor 'eye' (line 4)", "bands within 0.202 to 1000 um, or 'irradiance: FILE'"}},
      {"sunlight in nm", "135}}", "135}, irradiance: nanometres.txt}", {"2:66", "in nanometres? then 0.4 to 0.9 um"}},
      {"lamp too short",
       "sensors:",
       "lamps: [{kind: point, position_m: [0, 0, 9], intensity: short.txt}]\nsensors:",
       {"3:57", "intensity is given from 0.748 to 2.5 um"}},
      {"response in nm",
       "center_um: 0.55, fwhm_um: 0.01",
       "response: nanometres.txt",
       {"13:37", "in nanometres? then 0.4 to 0.9 um"}},
      {"preview of no sensor", "sensors:", "output: {previews: {aye: [green]}}\nsensors:", {"3:21", "'aye'", "'eye'"}},
      {"preview without bands",
       "sensors:",
       "output: {preview: {show: kelvin, bands: [a, b, c]}}\nsensors:",
       {"3:26", "of one band"}},
      {"preview upside down",
       "sensors:",
       "output: {preview: {stretch: [98, 2]}}\nsensors:",
       {"3:29", "a lower and a higher"}},
      {"preview twice",
       "sensors:",
       "output: {preview: {stretch: [2, 98], range: [0, 1]}}\nsensors:",
       {"exclude each other"}},
      {"files of the same names",
       "fwhm_um: 0.01}]",
       "fwhm_um: 0.01}]\n  - {kind: orthographic, name: eye_error, columns: 4, rows: 4, gsd_m: 1, center_m: [0, 0], "
       "paths: 4, "
       "bands: [{name: green, center_um: 0.55, fwhm_um: 0.01}]}",
       {"14:5", "'eye_error' and of sensor 'eye' have the same names"}},
      {"unknown preview", "sensors:", "output: {preview: [gren]}\nsensors:", {"'gren'", "did you mean 'green'"}},
  };
  for (const Mistake& m : table) {
    write("sim.yaml", replaced(kSimulation, m));
    check(m, run("dirsig-render sim.yaml -o out"));
    EXPECT_FALSE(file_exists(*folder_ / "out/eye.img")) << m.name;
  }
  check({"scene text for a simulation", "", "", {"text of a scene", "scene-prep"}},
        run("dirsig-render scene.yaml -o out"));
}

// What a scene lacks is told at the sensor that asks for it.
TEST_F(Messages, OfWhatASceneLacks) {
  const struct {
    const char *name, *scene, *sensor;
    std::vector<const char*> told;
  } table[] = {
      {"reflectance too short",
       "--set materials.grey.reflectance=short.txt --set windows_um=null",
       "--set seed=2",
       {"sim.yaml:4:5", "band 'green' of sensor 'eye' reaches from 0.5318 to 0.5682 um",
        "material 'grey' has its reflectance from 0.748 to 2.5 um"}},
      {"medium too short",
       "--set 'media={haze: {absorption: short.txt}}' --set materials.grey='{inside: haze}' --set windows_um=null",
       "--set seed=2",
       {"sim.yaml:4:5", "medium 'haze' has its absorption from 0.748 to 2.5 um"}},
      {"keyframes too short",
       "--set 'world.1.motion={kind: keyframes, keys: [{time_s: 0, position_m: [0, 0, 3]}, {time_s: 5, position_m: [1, "
       "0, 3]}]}'",
       "--set sensors.0.time_s=7",
       {"sim.yaml:4:5", "the motion of 'ball' (line",
        "of the scene's text) is known from 0 to 5 s, it is needed at 7 s"}},
  };
  write("sim.yaml", kSimulation);
  for (const auto& row : table) {
    const CommandResult made = run(std::string("scene-prep scene.yaml -o lacks.h5 ") + row.scene);
    ASSERT_EQ(made.code, 0) << row.name << made.out << made.err;
    const CommandResult r = run(std::string("dirsig-render sim.yaml -o out --set scene=lacks.h5 ") + row.sensor);
    EXPECT_EQ(r.code, 1) << row.name;
    for (const char* told : row.told) EXPECT_THAT(r.err, HasSubstr(told)) << row.name;
  }
}

// A scattering medium that fills half of all space is told; a layer, an absorbing one and one with a bottom are not.
TEST_F(Messages, OfEndlessMedia) {
  const std::string scene = "scene-prep scene.yaml -o endless.h5 --set materials.edge='{inside: fog}' ";
  const struct {
    const char *fog, *objects, *world;
    const char* told;  // null: nothing
  } table[] = {
      {"{scattering: 1}", "{top: {plane: {}, material: edge}}", "[{place: top}]",
       "scatters without ever being absorbed"},
      {"{scattering: 1, absorption: 0.001}", "{top: {plane: {}, material: edge}}", "[{place: top}]",
       "about 1001 times"},
      {"{scattering: 1}", "{top: {plane: {}, material: edge}}",
       "[{place: top, translate: [0, 0, 9]}, {place: top, rotate: {euler_deg: [180, 0, 0]}}]", "SP607] x2"},
      {"{scattering: 1}", "{top: {box: {z0: 0, z1: 9}, material: edge}}", "[{place: top}]", nullptr},
      {"{scattering: 1, absorption: 1}", "{top: {plane: {}, material: edge}}", "[{place: top}]", nullptr},
      {"{scattering: 1}", "{top: {plane: {}, material: edge}, bottom: {plane: {}, material: grey}}",
       "[{place: top, translate: [0, 0, 9]}, {place: bottom}]", nullptr},
  };
  for (const auto& row : table) {
    const CommandResult r = run(scene + "--set 'media={fog: " + row.fog + "}' --set 'objects=" + row.objects +
                                "' --set 'world=" + row.world + "'");
    EXPECT_EQ(r.code, 0) << r.err;
    if (row.told)
      EXPECT_THAT(r.out, HasSubstr(row.told));
    else
      EXPECT_EQ(r.out.find("SP607"), std::string::npos) << r.out;
  }
  const CommandResult ambient = run(
      "scene-prep scene.yaml -o endless.h5 --set 'media={fog: {scattering: 1, absorption: 0.001}}' --set ambient=fog");
  EXPECT_EQ(ambient.code, 0) << ambient.err;
  EXPECT_THAT(ambient.out, testing::AllOf(HasSubstr("SP607"), HasSubstr("all space that no body fills"),
                                          HasSubstr("about 1001 times")));
}

// Other values for once: told in what comes out, part of what a state belongs to, refused at their place.
TEST_F(Messages, OfSettings) {
  write("sim.yaml", kSimulation);
  ASSERT_EQ(run("dirsig-render sim.yaml -o set --state --set sensors.eye.columns=6 --set 'sky={radiance: 3}'").code, 0);
  EXPECT_THAT(read_text(*folder_ / "set/eye.img.hdr"), HasSubstr("samples = 6"));
  EXPECT_THAT(read_text(*folder_ / "set/render.json"), HasSubstr("--set sensors.eye.columns=6"));
  const CommandResult same =
      run("dirsig-render sim.yaml -o set --resume --set sensors.eye.columns=6 --set 'sky={radiance: 3}'");
  EXPECT_EQ(same.code, 0) << same.err;
  for (const char* other :
       {"", "--set sensors.eye.columns=6", "--set sensors.eye.columns=6 --set 'sky={radiance: 4}'"}) {
    const CommandResult r = run(std::string("dirsig-render sim.yaml -o set --resume ") + other);
    EXPECT_EQ(r.code, 1) << other;
    EXPECT_THAT(r.err, HasSubstr("belongs to another run: its simulation is")) << other;
  }
  const CommandResult r = run("dirsig-render sim.yaml -o wrong --set sensors.0.pahts=64");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("--set sensors.0.pahts: error: unknown key 'pahts'; did you mean 'paths'?"));
  EXPECT_FALSE(file_exists(*folder_ / "wrong"));
}

// One class without a material is one fault, however many pixels have it.
TEST_F(Messages, CountsAnUnmappedClassOnce) {
  write("classes.pgm", "P2\n4 4\n255\n1 1 1 1\n1 1 1 1\n1 1 1 1\n3 3 3 3\n");
  std::string text = kScene;
  text.replace(
      text.find("objects:"), 0,
      "  land: {map: cover}\nmaps:\n  cover: {type: class, file: classes.pgm, materials: {1: grey}, projection: drape, "
      "drape: {origin: [-10, 10], gsd: 5}}\n");
  write("wrong.yaml", text);
  const CommandResult r = run("scene-prep wrong.yaml -o wrong.h5");
  EXPECT_THAT(r.out + r.err, HasSubstr("SP502] x1")) << r.out << r.err;
}

// A terrain that brings its own coordinates tells where an origin was meant to be.
TEST_F(Messages, OfMisplacedOrigins) {
  const std::string dem = SUITE_SOURCE_DIR "/sample_scenes/calibration_range/dem_hd_sub.tif";
  const auto scene = [&](double latitude, double longitude) {
    return strf(
        "scene: 1\norigin: {latitude_deg: %g, longitude_deg: %g, height_m: 100}\nmaterials:\n"
        "  grey: {model: lambert, reflectance: 0.2}\nobjects:\n  land: {terrain: '%s', height: ellipsoid, "
        "material: grey}\nworld:\n  - {place: land}\n",
        latitude, longitude, dem.c_str());
  };
  const struct {
    double latitude, longitude;
    const char* told;
  } table[] = {
      {8.7, 49.4, "exchanged"}, {49.4, -8.7, "longitude the wrong sign"}, {-49.4, 8.7, "latitude the wrong sign"}};
  for (const auto& row : table) {
    write("wrong.yaml", scene(row.latitude, row.longitude));
    const CommandResult r = run("scene-prep wrong.yaml -o wrong.h5");
    EXPECT_THAT(r.out + r.err, HasSubstr("SP505"));
    EXPECT_THAT(r.out + r.err, HasSubstr(row.told));
    EXPECT_THAT(r.out + r.err, HasSubstr("it covers latitudes 49.")) << "the extent of what is there";
  }
  write("right.yaml", scene(49.4, 8.7));
  const CommandResult right = run("scene-prep right.yaml -o right.h5");
  EXPECT_EQ(right.code, 0) << right.err;
  EXPECT_EQ((right.out + right.err).find("SP505"), std::string::npos);
}

TEST_F(Messages, OfTwoJobsInOneCommand) {
  write("scene.yaml", kScene);
  const CommandResult r = run("scene-prep scene.yaml -o scene.h5 --quick-look look.png");
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err,
              HasSubstr("two commands, scene-prep SCENE.yaml -o SCENE.h5, then scene-prep SCENE.h5 --quick-look"));
}

// A number that stands for "not given" is no default.
TEST_F(Messages, HelpShowsNoNumberThatIsNone) {
  for (const char* program : {"dirsig-render", "scene-prep", "sqt-fit"}) {
    const std::string help = run(std::string(program) + " --help").out;
    EXPECT_THAT(help, HasSubstr("--threads"));
    EXPECT_EQ(help.find("=-1"), std::string::npos) << program;
  }
}

TEST_F(Messages, OfForeignMeasurements) {
  const struct {
    const char *name, *text, *told;
  } table[] = {{"radiance.xml", "<?xml version=\"1.0\"?>\n<WindowElement></WindowElement>", "Radiance/Window XML"},
               {"data.alta", "#DIM 3 1\n#VS 1\n", "ALTA"},
               {"packed.zip", "PK\x03\x04 more", "zip archive"}};
  for (const auto& row : table) {
    write(row.name, row.text);
    const CommandResult r = run(std::string("sqt-fit ") + row.name + " -o fit.sqt");
    EXPECT_EQ(r.code, 1) << row.name;
    EXPECT_THAT(r.err, HasSubstr(row.told));
  }
}

// What the help says of it: no progress, but warnings of what a result lacks, and the findings, which are results.
TEST_F(Messages, QuietKeepsWarningsAndResults) {
  const std::string convert = "scene-prep '" SUITE_TEST_DATA "/dirsig/range.scene' --convert texts";
  for (const bool quiet : {false, true}) {
    const CommandResult r = run(convert + (quiet ? " -q" : ""));
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.err, HasSubstr("warning: something of it is lost"));
    EXPECT_EQ(r.err.find("wrote ") == std::string::npos, quiet) << r.err;
  }
  write("spare.yaml",
        std::string(kScene).insert(kScene.find("objects:"), "  spare: {model: lambert, reflectance: 0.1}\n"));
  const CommandResult r = run("scene-prep spare.yaml -o spare.h5 -q");
  EXPECT_THAT(r.out, HasSubstr("SP103"));
  EXPECT_EQ(r.err, "");
  EXPECT_THAT(run("scene-prep --help").out, HasSubstr("errors, warnings and results, no progress"));
}

}  // namespace
}  // namespace suite::messages_test
