// The sensors' sample scenes run from their scripts to their results, small.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/run_command.h"

namespace suite::sensor_scenes_test {
namespace {

const std::string kSamples = SUITE_SOURCE_DIR "/sample_scenes/";
const std::string kPath = "export PATH='" SUITE_BIN_DIR "':$PATH && ";

TEST(SampleScenes, TriBarTargetFromACirclingCamera) {
  if (run_command("command -v python3").code != 0) GTEST_SKIP() << "python3 is not installed";
  const TempFolder folder;
  // The same pictures with pixels ten times as large.
  CommandResult r = run_command("cp -r '" + kSamples + "uas_tribar' '" + (folder / "s") + "' && cd '" + (folder / "s") +
                                "' && sed -i 's/columns: 1280/columns: 128/; s/rows: 720/rows: 72/; s/pitch_um: "
                                "6.5/pitch_um: 65/' still.yaml moving.yaml jitter.yaml && " +
                                kPath + "./run ../work 4");
  ASSERT_EQ(r.code, 0) << r.out << r.err;
  for (const char* name : {"still", "moving", "jitter"}) {
    const EnviImage image(folder / ("work/out/" + std::string(name) + ".img")),
        truth(folder / ("work/out/" + std::string(name) + "_truth.img"));
    ASSERT_EQ(image.header().samples, 128u);
    for (const double v : image.read_all()) ASSERT_TRUE(std::isfinite(v) && v >= 0);
    // The middle of the picture is the stare point.
    const std::vector<double> t = truth.read_all();
    const double* at = &t[(36 * 128 + 64) * truth.header().bands];
    EXPECT_NEAR(at[0], 0, 0.3) << name;
    EXPECT_NEAR(at[1], 0, 0.8) << name;
  }
}

TEST(SampleScenes, RamiCanopy) {
  if (run_command("command -v python3").code != 0) GTEST_SKIP() << "python3 is not installed";
  const TempFolder folder;
  const CommandResult r = run_command(kPath + "python3 '" + kSamples + "rami_hom03/make_inputs.py' '" + folder.path() +
                                      "' --half-width 1 && cd '" + folder.path() +
                                      "' && scene-prep scene_red.yaml -o scene_red.h5 -q && dirsig-render "
                                      "sim_red_50.yaml -o out --paths 64 -q && python3 '" +
                                      kSamples + "rami_hom03/plot.py' plot.svg out/hom03_red_50_brf.csv");
  ASSERT_EQ(r.code, 0) << r.out << r.err;
  const std::string brf = read_text(folder / "out/hom03_red_50_brf.csv"),
                    mes = read_text(folder / "out/brfpp_suite-hom03_red_50_red.mes");
  EXPECT_EQ(std::count(brf.begin(), brf.end(), '\n'), 1 + 152);
  EXPECT_EQ(std::count(mes.begin(), mes.end(), '\n'), 1 + 76);
  EXPECT_THAT(read_text(folder / "out/hom03_red_50_fluxes.csv"), testing::HasSubstr("red,absorbed_by_canopy,0."));
  EXPECT_TRUE(file_exists(folder / "plot.svg"));
}

// A thinner forest with fewer paths: what is measured by the goniometer and fitted reflects as its trees do, in the
// mean over the views of a plane (3.1 % at worst when this was written, of which 1.7 % is noise; the whole sample's are
// smaller).
TEST(SampleScenes, AForestAsASurface) {
  if (run_command("command -v python3").code != 0) GTEST_SKIP() << "python3 is not installed";
  const TempFolder folder;
  const std::string sample = kSamples + "tree_to_sqt/";
  const CommandResult r = run_command(
      kPath + "cd '" + folder.path() + "' && python3 '" + sample +
      "make_inputs.py' . --leaves 60 --paths 60000 --views 128 && sed -i 's/rings: 24/rings: 12/; s/azimuths: "
      "24/azimuths: 12/' measure.yaml && scene-prep forest.yaml -o forest.h5 -q && dirsig-render measure.yaml -o "
      "out -q && sqt-fit out/canopy.rawbh -o canopy.sqt --views 8 --order 4 --min-peak 0 && scene-prep "
      "surface.yaml -o surface.h5 -q && for v in view_*.yaml; do dirsig-render $v -o out -q; done && python3 '" +
      sample + "compare.py' .");
  ASSERT_EQ(r.code, 0) << r.out << r.err;
  std::istringstream lines(r.out.substr(r.out.find("sun  band")));
  std::string line;
  std::getline(lines, line);
  int planes = 0;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string sun, band, plane;
    double mean = 1e9;
    if (!(words >> sun >> band >> plane >> mean)) continue;  // how many views are within 3 %
    EXPECT_LT(std::fabs(mean), 4) << line;
    ++planes;
  }
  EXPECT_EQ(planes, 8);
}

TEST(SampleScenes, OneAFeature) {
  if (run_command("command -v python3").code != 0) GTEST_SKIP() << "python3 is not installed";
  const TempFolder folder;
  const CommandResult r = run_command(kPath + "'" + kSamples + "features/run' '" + folder.path() + "' && python3 '" +
                                      kSamples + "features/expect.py' '" + folder.path() + "'");
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  size_t lines = 0;
  for (size_t at = r.out.find("  expected "); at != std::string::npos; at = r.out.find("  expected ", at + 1)) ++lines;
  EXPECT_EQ(lines, 15u) << r.out;
}

}  // namespace
}  // namespace suite::sensor_scenes_test
