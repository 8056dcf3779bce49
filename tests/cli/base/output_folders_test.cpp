// Folders of outputs: every program makes those that are missing, parents too, and names files without needless
// slashes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "support/run_command.h"

namespace suite::output_folders_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class OutputFolders : public testing::Test {
 protected:
  OutputFolders() {
    write_file(folder_ / "scene.yaml",
               std::string_view("scene: 1\nmaterials:\n  grey: {model: lambert, reflectance: 0.2}\nobjects:\n  plane: "
                                "{plane: {width: 4, depth: 4}, material: grey}\nworld:\n  - {place: plane}\n"));
    write_file(
        folder_ / "sim.yaml",
        std::string_view("scene: a/b/scene.h5\nsun: {direction: {zenith_deg: 30, azimuth_deg: 0}, irradiance: "
                         "1000}\noutput: {also: [geotiff, exr]}\nsensors: [{kind: orthographic, columns: 4, rows: "
                         "4, gsd_m: 1, center_m: [0, 0], paths: 1, bands: [{name: pan, center_um: 0.6, fwhm_um: "
                         "0.1}]}]\n"));
  }
  CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/" + command);
  }
  void good(const std::string& command, const std::vector<std::string>& files) {
    const CommandResult r = run(command);
    EXPECT_EQ(r.code, 0) << command << "\n" << r.err;
    EXPECT_THAT(r.out + r.err, Not(HasSubstr("//"))) << command;
    for (const std::string& f : files) EXPECT_TRUE(file_exists(folder_ / f)) << f;
  }
  TempFolder folder_;
};

TEST_F(OutputFolders, AreMadeByAllPrograms) {
  good("scene-prep scene.yaml -o a/b/scene.h5 --report c/d/report.json", {"a/b/scene.h5", "c/d/report.json"});
  good("scene-prep a/b/scene.h5 --export-obj e/f/scene.obj --quick-look g/h/look.png",
       {"e/f/scene.obj", "g/h/look.png"});
  good("dirsig-render sim.yaml -o i/j//", {"i/j/map.img", "i/j/map.tif", "i/j/map.exr", "i/j/render.json"});
  good("dirsig-render sim.yaml -o k/l/ --state", {"k/l/result.state.h5"});
  good("dirsig-render sim.yaml --study m/n/ --study-budgets 4,8 --study-seeds 2",
       {"m/n/study.csv", "m/n/reference.img"});
  good("sqt-fit --model lambert:reflectance=0.3 -o o/p/fit.sqt --report q/r/fit.json --max-error 0.1",
       {"o/p/fit.sqt", "q/r/fit.json"});
  good("sqt-inspect o/p/fit.sqt --slice s/t/slice.csv --views 30 --sphere u/v/sphere.png",
       {"s/t/slice.csv", "u/v/sphere.png"});
}

TEST_F(OutputFolders, ThatCannotBeMadeAreToldWithTheFile) {
  good("scene-prep scene.yaml -o a/b/scene.h5", {});
  write_file(folder_ / "wall", std::string_view("a file"));
  for (const char* command :
       {"scene-prep scene.yaml -o wall/x/scene2.h5", "sqt-fit --model lambert:reflectance=0.3 -o wall/x/fit.sqt"}) {
    const CommandResult r = run(command);
    EXPECT_EQ(r.code, 1) << command;
    EXPECT_THAT(r.err, HasSubstr("cannot be written: wall/x: ")) << command;
    EXPECT_THAT(r.err, HasSubstr("folder cannot be made")) << command;
  }
  EXPECT_EQ(run("dirsig-render sim.yaml -o wall/x").code, 1);
}

// Nothing is made for an input that is refused.
// A run that found no room for its state said that the state held what was finished, and how to go on from it.
TEST_F(OutputFolders, OfFullDisksPromiseNothing) {
  good("scene-prep scene.yaml -o a/b/scene.h5", {});
  const CommandResult r =
      run_command("cd '" + folder_.path() +
                  "' && trap '' XFSZ && ulimit -f 16 && " SUITE_BIN_DIR "/dirsig-render sim.yaml -o full --state");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("0 of 1 captures are complete; no state could be kept"));
  EXPECT_FALSE(file_exists(folder_ / "full/result.state.h5"));
}

TEST_F(OutputFolders, AreNotMadeForBadInput) {
  write_file(folder_ / "bad.yaml", std::string_view("scene: 1\nmaterials: {grey: {model: lambert}}\n"));
  EXPECT_EQ(run("scene-prep bad.yaml -o w/x/scene.h5").code, 1);
  EXPECT_EQ(run("sqt-fit nothing.binary -o w/x/fit.sqt").code, 1);
  EXPECT_EQ(run("sqt-inspect nothing.sqt --sphere w/x/y.png").code, 1);
  EXPECT_NE(run_command("test -e '" + (folder_ / "w") + "'").code, 0);
}

}  // namespace
}  // namespace suite::output_folders_test
