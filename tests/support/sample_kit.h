// A sample scene of sample_scenes, run by both programs in a folder of the test's own.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "formats/envi/envi.h"
#include "support/run_command.h"

namespace suite {

class SampleScene : public testing::Test {
 protected:
  explicit SampleScene(std::string name) : name_(std::move(name)) {}
  void SetUp() override {
    run_command("cp -r " SUITE_SOURCE_DIR "/sample_scenes/" + name_ + "/. " + folder_.path());
    const CommandResult r = run("scene-prep scene.yaml -o scene.h5");
    ASSERT_EQ(r.code, 0) << r.err;
  }
  CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/" + command + " -q");
  }
  // Renders into the folder `to`.
  void render(const std::string& to, const std::string& options) {
    const CommandResult r = run("dirsig-render sim.yaml -o " + to + " " + options);
    ASSERT_EQ(r.code, 0) << r.err;
  }
  // The same ground in a quarter of the columns and rows: for `sensors` cameras of 96 x 72 detectors of 10 um.
  void render_small(const std::string& to, const std::string& options, int sensors = 2) {
    std::string sets;
    for (int s = 0; s < sensors; ++s)
      for (const char* value : {"columns=24", "rows=18", "pitch_um=40"})
        sets += " --set sensors." + std::to_string(s) + "." + value;
    render(to, options + sets);
  }
  // A value of a picture in the folder.
  double value(const std::string& picture, size_t column, size_t row, size_t band) {
    const EnviImage image(folder_ / picture);
    return image.read_lines(row, 1).at(column * image.header().bands + band);
  }
  TempFolder folder_;

 private:
  std::string name_;
};

}  // namespace suite
