// Programs against inputs and places that would do harm: outputs over inputs, names that lead elsewhere, numbers beyond
// all measure, disks that are full, signals in the middle of the work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

namespace suite::hostile_input_test {
namespace {

using testing::HasSubstr;

class Hostile : public ::testing::Test {
 protected:
  Hostile() {
    write_file(folder_ / "t.obj", "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n");
    write_file(folder_ / "scene.yaml",
               "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\n"
               "objects: {t: {obj: t.obj, material: grey}}\nworld: [{place: t}]\n");
    write_file(folder_ / "sim.yaml", sim(camera("cam", "position_m: [0, 0, 9], look_at_m: [0, 1, 0]")));
  }
  CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_.path() + "' && PATH='" SUITE_BIN_DIR "':$PATH && " + command);
  }
  void prepare() {
    const CommandResult r = run("scene-prep scene.yaml -o scene.h5");
    ASSERT_EQ(r.code, 0) << r.err;
  }
  static std::string camera(const std::string& name, const std::string& place, int edge = 6, int paths = 4) {
    return strf("  - {kind: frame_camera, name: \"%s\", columns: %d, rows: %d, pitch_um: 900, focal_length_mm: 9, ",
                name.c_str(), edge, edge) +
           place + strf(", paths: %d, bands: [{name: b, center_um: 0.5, fwhm_um: 0.02}]}\n", paths);
  }
  static std::string sim(const std::string& sensors) {
    return "scene: scene.h5\nsky: {radiance: 10}\nsensors:\n" + sensors;
  }
  // Files of the folder that a program should have taken with it.
  size_t left_overs(const std::string& folder) const {
    size_t n = 0;
    if (std::filesystem::exists(folder))
      for (const auto& e : std::filesystem::directory_iterator(folder))
        n += e.path().filename().string().find(".part-") != std::string::npos;
    return n;
  }
  TempFolder folder_;
};

TEST_F(Hostile, NoProgramReplacesItsInputs) {
  prepare();
  ASSERT_EQ(run("sqt-fit --model 'lambert:reflectance=0.3' -o w.sqt").code, 0);
  write_file(
      folder_ / "m.csv",
      "# name: x\n# quantity: bsdf\ntheta_o_deg,phi_o,theta_i,phi_i,wavelength_um,value\n30,0,0.5,3.1,0.5,0.1\n");
  std::filesystem::create_symlink(folder_ / "t.obj", folder_ / "link.obj");
  std::filesystem::create_hard_link(folder_ / "scene.h5", folder_ / "cam.img");
  const std::string scene = read_text(folder_ / "scene.yaml"), mesh = read_text(folder_ / "t.obj"),
                    prepared = read_text(folder_ / "scene.h5"), tree = read_text(folder_ / "w.sqt"),
                    data = read_text(folder_ / "m.csv");
  for (const char* command : {"scene-prep scene.yaml -o scene.yaml", "scene-prep scene.yaml -o ./scene.yaml",
                              "scene-prep scene.yaml -o t.obj", "scene-prep scene.yaml -o link.obj",
                              "scene-prep scene.yaml --report scene.yaml", "scene-prep scene.yaml -o x --report x",
                              "scene-prep scene.h5 --export-obj scene.h5", "scene-prep scene.h5 --quick-look scene.h5",
                              "sqt-inspect w.sqt --map w.sqt", "sqt-inspect w.sqt --slice w.sqt",
                              "sqt-inspect w.sqt --compare m.csv --error-map m.csv", "sqt-fit m.csv -o m.csv",
                              "sqt-fit m.csv --report m.csv", "dirsig-render sim.yaml -o ."}) {
    const CommandResult r = run(command);
    EXPECT_EQ(r.code, 2) << command << "\n" << r.err;
    EXPECT_TRUE(r.err.find("would replace an input") != std::string::npos ||
                r.err.find("is named twice") != std::string::npos)
        << command << "\n"
        << r.err;
  }
  EXPECT_EQ(read_text(folder_ / "scene.yaml"), scene);
  EXPECT_EQ(read_text(folder_ / "t.obj"), mesh);
  EXPECT_EQ(read_text(folder_ / "scene.h5"), prepared);
  EXPECT_EQ(read_text(folder_ / "w.sqt"), tree);
  EXPECT_EQ(read_text(folder_ / "m.csv"), data);
  // What a run made itself, it may make again.
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(run("scene-prep scene.yaml -o scene.h5 --force").code, 0);
    EXPECT_EQ(run("dirsig-render sim.yaml -o out --state").code, 0);
  }
}

// A picture of the sky was replaced by the preview of a sensor of its name, for another library had opened it; and a
// track, a page and a table of weather were found to be inputs only when all was rendered.
TEST_F(Hostile, WhatOtherLibrariesReadIsNotReplacedEither) {
  prepare();
  // 1 x 1, 8-bit RGB.
  const unsigned char png[] = {0x89, 'P',  'N',  'G',  0x0d, 0x0a, 0x1a, 0x0a, 0,   0,    0,    13,   'I',  'H',
                               'D',  'R',  0,    0,    0,    1,    0,    0,    0,   1,    8,    2,    0,    0,
                               0,    0x90, 0x77, 0x53, 0xde, 0,    0,    0,    12,  'I',  'D',  'A',  'T',  0x78,
                               0x9c, 0x63, 0x60, 0x60, 0x60, 0,    0,    0,    4,   0,    1,    0xf6, 0x17, 0x38,
                               0x55, 0,    0,    0,    0,    'I',  'E',  'N',  'D', 0xae, 0x42, 0x60, 0x82};
  const std::string place = "position_m: [0, 0, 9], look_at_m: [0, 1, 0]";
  const auto rendered = [&](const std::string& picture, const std::string& options) {
    write_file(folder_ / "sky.yaml", "scene: scene.h5\nsky: {kind: image, file: " + picture +
                                         ", wavelength_um: [0.45, 0.55, 0.65]}\nsensors:\n" + camera("cam", place));
    return run("dirsig-render sky.yaml " + options);
  };
  const auto put = [&](const std::string& name) { write_file(folder_ / name, std::as_bytes(std::span(png))); };
  put("cam.png"), put("far.png");
  std::filesystem::create_directories(folder_ / "hard");
  std::filesystem::create_directories(folder_ / "soft");
  std::filesystem::create_hard_link(folder_ / "far.png", folder_ / "hard/cam.png");
  std::filesystem::create_symlink("../far.png", folder_ / "soft/cam_quality.tif");
  for (const auto& [picture, options] : {std::pair<std::string, std::string>{"cam.png", "-o ."},
                                         {"far.png", "-o hard"},
                                         {"far.png", "-o soft"},
                                         {"far.png", "-o out --view far.png"},
                                         {"far.png", "-o out --view scene.h5"}}) {
    const CommandResult r = rendered(picture, options);
    EXPECT_EQ(r.code, 2) << picture << " " << options << "\n" << r.err;
    EXPECT_THAT(r.err, HasSubstr("would replace an input")) << options;
    EXPECT_EQ(r.err.find("median relative"), std::string::npos) << "only after rendering: " << options;
  }
  const CommandResult page = rendered("far.png", "-o out --view ./out/cam.png");
  EXPECT_EQ(page.code, 2) << page.err;
  EXPECT_THAT(page.err, HasSubstr("'./out/cam.png' has the name of a result of this run"));
  for (const char* name : {"cam.png", "far.png", "hard/cam.png"})
    EXPECT_EQ(read_bytes(folder_ / name).size(), sizeof png) << name;
  // What an earlier run made is an input of the next one.
  EXPECT_EQ(rendered("far.png", "-o out").code, 0);
  const std::vector<std::byte> before = read_bytes(folder_ / "out/cam.png");
  EXPECT_EQ(rendered("out/cam.png", "-o out").code, 2);
  EXPECT_EQ(read_bytes(folder_ / "out/cam.png"), before);
}

TEST_F(Hostile, NamesStayInTheFolder) {
  prepare();
  for (const char* name :
       {"../evil", "a/b", "", ".", "..", "a\\eb", "0123456789012345678901234567890123456789012345678"}) {
    write_file(folder_ / "bad.yaml", sim(camera(name, "position_m: [0, 0, 9], look_at_m: [0, 1, 0]")));
    const CommandResult r = run("dirsig-render bad.yaml -o out/deep");
    EXPECT_EQ(r.code, 1) << name;
    EXPECT_THAT(r.err, HasSubstr("bad.yaml:4:32: error: ")) << name;
    EXPECT_EQ(r.err.find('\x1b'), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

// Each ended in an abort, a hang, "please report this bug", or with all memory taken.
TEST_F(Hostile, NumbersBeyondAllMeasureAreRefusedAtTheirPlace) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer's address space is larger than any limit";
#endif
  prepare();
  const auto told = [&](const std::string& command, const std::string& message) {
    const CommandResult r = run("bash -c 'ulimit -v 8000000; timeout 600 " + command + "'");
    EXPECT_EQ(r.code, 1) << command << "\n" << r.err;
    EXPECT_THAT(r.out + r.err, HasSubstr(message)) << command;
  };
  const auto view = [&](const std::string& place) { write_file(folder_ / "bad.yaml", sim(camera("cam", place))); };
  view("position_m: [0, 0, 9], look_at_m: [0, 1.0e300, -1]");
  told("dirsig-render bad.yaml -o out", "bad.yaml:4:");
  view("position_m: [1.0e300, 0, 9], look_at_m: [0, 1, 0]");
  told("dirsig-render bad.yaml -o out", "1e+300 is too large");
  write_file(folder_ / "bad.yaml",
             sim("  - {kind: point, collectors: [{quantity: radiance, position_m: [0, 0, 1], look: "
                 "[0, 1.0e300, -1]}], bands: [{name: b, center_um: 0.5, fwhm_um: 0.02}]}\n"));
  told("dirsig-render bad.yaml -o out", "bad.yaml:4:86: error: 1e+300 is too large");
  const auto scene = [&](const std::string& objects, const std::string& world) {
    write_file(folder_ / "bad.yaml",
               "scene: 1\nmaterials: {grey: {model: lambert, reflectance: 0.2}}\nobjects: {t: {obj: t.obj, "
               "material: grey}" +
                   objects + "}\n" + world);
  };
  scene("", "world: [{place: t, rotate: {quaternion: [1.0e300, 0, 0, 1.0e300]}}]\n");
  told("scene-prep bad.yaml -o bad.h5", "bad.yaml:4:");
  scene(", sea: {sinusoid: {width: 10, depth: 10, terms: [{amplitude: 1, kx: 1.0e18}]}, material: grey}",
        "world: [{place: t}, {place: sea}]\n");
  told("scene-prep bad.yaml -o bad.h5", "waves fit across the surface; at most 100000");
  std::string groups = "groups:\n";
  for (int level = 0; level < 12; ++level) {
    groups += strf("  g%d: [", level);
    for (int copy = 0; copy < 10; ++copy)
      groups += strf("%s{place: %s, translate: [%d, 0, 0]}", copy ? ", " : "",
                     level == 11 ? "t" : strf("g%d", level + 1).c_str(), copy);
    groups += "]\n";
  }
  scene("", groups + "world: [{place: g0}]\n");
  told("scene-prep bad.yaml -o bad.h5", "[SP411]");
}

TEST_F(Hostile, AFullDiskIsToldAndCostsNothingThatIsFinished) {
  prepare();
  // A mesh of 20000 triangles does not fit into 64 kB.
  std::string obj;
  for (int i = 0; i < 20000; ++i) obj += strf("v %d 0 0\nv %d 1 0\nv %d 0 1\nf -3 -2 -1\n", i, i, i);
  write_file(folder_ / "t.obj", obj);
  const CommandResult r = run("bash -c 'ulimit -f 64; scene-prep scene.yaml -o big.h5 --no-crossing-check'");
  EXPECT_EQ(r.code, 1) << r.err;
  EXPECT_THAT(r.err, HasSubstr("big.h5: error: cannot be written"));
  EXPECT_FALSE(file_exists(folder_ / "big.h5"));
  EXPECT_EQ(left_overs(folder_.path()), 0u);
  // Images that cannot fit are refused before anything is rendered.
  write_file(folder_ / "wide.yaml", sim(camera("cam", "position_m: [0, 0, 9], look_at_m: [0, 1, 0]", 400)));
  const CommandResult wide = run("bash -c 'ulimit -f 64; dirsig-render wide.yaml -o out'");
  EXPECT_EQ(wide.code, 1) << wide.err;
  EXPECT_THAT(wide.err, HasSubstr("and files may have"));
  EXPECT_EQ(wide.err.find("median relative"), std::string::npos);
}

TEST_F(Hostile, AResultThatCannotBeWrittenLeavesTheOthersAndTheState) {
  prepare();
  const std::string place = "position_m: [0, 0, 9], look_at_m: [0, 1, 0]";
  write_file(folder_ / "two.yaml", sim(camera("a", place) + camera("b", place)));
  std::filesystem::create_directories(folder_ / "out/b.png");  // stands where a file has to go
  const CommandResult r = run("dirsig-render two.yaml -o out --state");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("out/b.png: error: is a directory"));
  EXPECT_THAT(r.err, HasSubstr("1 of 2 captures are complete in out; out/result.state.h5 holds the finished captures"));
  EXPECT_TRUE(file_exists(folder_ / "out/a.img"));
  EXPECT_EQ(left_overs(folder_ / "out"), 0u);
  std::filesystem::remove(folder_ / "out/b.png");
  const CommandResult again = run("dirsig-render two.yaml -o out --resume");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("the state holds 2 of 2 captures whole and 288 paths, which are not run again"));
  EXPECT_TRUE(file_exists(folder_ / "out/b.img"));
}

TEST_F(Hostile, ASignalKeepsWhatIsDoneAndResumeGoesOnFromIt) {
  prepare();
  const std::string place = "position_m: [0, 0, 9], look_at_m: [0, 1, 0]";
  write_file(folder_ / "long.yaml", sim(camera("a", place) + camera("b", place, 48, 3000)));
  const CommandResult r =
      run("bash -c 'set -m; dirsig-render long.yaml -o out --state -j 1 & pid=$!; "
          "while [ ! -e out/a.png ]; do sleep 0.02; done; sleep 0.3; kill -INT $pid; wait $pid'");
  ASSERT_EQ(r.code, 130) << r.err;
  EXPECT_THAT(r.err, HasSubstr("stopping in good order"));
  EXPECT_THAT(
      r.err,
      HasSubstr("stopped: 1 of 2 captures are complete in out; out/result.state.h5 holds the finished captures"));
  EXPECT_THAT(r.err, HasSubstr("[DR902]"));
  EXPECT_TRUE(file_exists(folder_ / "out/a.img"));
  EXPECT_FALSE(file_exists(folder_ / "out/b.img"));
  EXPECT_EQ(left_overs(folder_ / "out"), 0u);
  const CommandResult again = run("dirsig-render long.yaml -o out --resume");
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("the state holds 1 of 2 captures whole and "));
  ASSERT_EQ(run("dirsig-render long.yaml -o whole").code, 0);
  for (const char* file : {"a.img", "b.img", "b_error.img"})
    EXPECT_EQ(read_bytes(folder_ / ("out/" + std::string(file))), read_bytes(folder_ / ("whole/" + std::string(file))))
        << file;
}

}  // namespace
}  // namespace suite::hostile_input_test
