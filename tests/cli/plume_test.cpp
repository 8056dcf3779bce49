// The plume scene through both programs, with few paths: a cloud brighter than the meadow, a shadow darker, media in
// the summary, and faults of media told at their place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/run_command.h"

using namespace suite;
using testing::HasSubstr;

namespace {

const std::string kBin = SUITE_BIN_DIR "/";

class Plume : public testing::Test {
 protected:
  Plume() { run_command("cp -r " SUITE_SOURCE_DIR "/sample_scenes/plume/. " + folder_.path()); }
  CommandResult run(const std::string& command) {
    return run_command("cd " + folder_.path() + " && " + kBin + command);
  }
  void change(const std::string& file, const std::string& from, const std::string& to) {
    std::string text = read_text(folder_ / file);
    const size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write_file(folder_ / file, text.replace(at, from.size(), to));
  }
  TempFolder folder_;
};

TEST_F(Plume, CloudShadowAndSmoke) {
  change("sim.yaml", "columns: 480", "columns: 60");
  change("sim.yaml", "rows: 320", "rows: 40");
  change("sim.yaml", "pitch_um: 20", "pitch_um: 160");
  const CommandResult prep = run("scene-prep scene.yaml -o scene.h5"),
                      render = run("dirsig-render sim.yaml -o out --paths 64 -q");
  ASSERT_EQ(prep.code, 0) << prep.err;
  ASSERT_EQ(render.code, 0) << render.err;
  EXPECT_THAT(run("scene-prep --summary scene.h5").out, HasSubstr("voxel grids   2 in 2 volumes"));
  const EnviImage image(folder_ / "out/oblique.img");
  const auto red = [&](size_t column, size_t row) {  // mean of 3 x 3 pixels
    double sum = 0;
    for (size_t r = row - 1; r <= row + 1; ++r)
      for (size_t c = column - 1; c <= column + 1; ++c) sum += image.read_lines(r, 1)[3 * c + 2];
    return sum / 9;
  };
  const double cloud = red(16, 6), meadow = red(12, 27), shadow = red(50, 29);
  EXPECT_GT(cloud, 3 * meadow);
  EXPECT_LT(shadow, 0.8 * meadow);
  EXPECT_GT(shadow, 0.05 * meadow);
}

TEST_F(Plume, FaultsOfMedia) {
  change("scene.yaml", "medium: droplets", "medium: dropets");
  change("scene.yaml", "    index: 1.34\n", "    index: 1.34\n    extinction: 3\n");
  change("plume.vox", "[96, 40, 32]", "[96, 40, 33]");
  const CommandResult prep = run("scene-prep scene.yaml -o scene.h5");
  EXPECT_EQ(prep.code, 1);
  EXPECT_THAT(prep.err, HasSubstr("did you mean 'droplets'?"));
  EXPECT_THAT(prep.err, HasSubstr("extinction 3 is not absorption"));
  EXPECT_THAT(prep.err, HasSubstr("'plume.u8' has 122880 bytes, the grid needs 126720"));
}

}  // namespace
