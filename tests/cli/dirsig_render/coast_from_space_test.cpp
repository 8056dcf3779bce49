// A satellite's view through real air, through both programs: what surfaces and air make of reflectances and
// temperatures, in the bounds of expect.md of the sample.
#include <gtest/gtest.h>

#include <cstdio>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/run_command.h"

namespace suite {
namespace {

class CoastFromSpace : public testing::Test {
 protected:
  void SetUp() override {
    run_command("cp -r " SUITE_SOURCE_DIR "/sample_scenes/coast_from_space/. " + folder_.path());
    ASSERT_EQ(run("scene-prep scene.yaml -o scene.h5").code, 0);
  }
  CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/" + command + " -q");
  }
  // Small pictures.
  void render(const std::string& to, const std::string& options) {
    std::string sets;
    for (const char* sensor : {"0", "1"})
      for (const char* value : {"columns=24", "rows=18", "pitch_um=40"})
        sets += std::string(" --set sensors.") + sensor + "." + value;
    const CommandResult r = run("dirsig-render sim.yaml -o " + to + " " + options + sets);
    ASSERT_EQ(r.code, 0) << r.err;
  }
  TempFolder folder_;
};

constexpr size_t kBands = 7;

TEST_F(CoastFromSpace, IsSeenThroughItsAir) {
  render("even", "--paths 64 --set atmosphere.adjacency=false");
  const EnviImage solar(folder_ / "even/solar.img"), thermal(folder_ / "even/thermal.img");
  const std::vector<double> middle = solar.read_lines(9, 1), edge = solar.read_lines(1, 1);
  struct Row {
    size_t band;
    double grass_low, grass_high, sea_low, sea_high;
  };
  for (const Row& r :
       {Row{0, 0.108, 0.132, 0.108, 0.132}, Row{2, 0.066, 0.082, 0.043, 0.054}, Row{3, 0.12, 0.18, 0.012, 0.021},
        Row{4, 0.38, 0.44, 0.022, 0.031}, Row{5, 0, 0.002, 0, 0.002}, Row{6, 0.22, 0.26, 0.009, 0.015}}) {
    const double grass = middle[12 * kBands + r.band], sea = edge[kBands + r.band];
    EXPECT_GT(grass, r.grass_low) << r.band;
    EXPECT_LT(grass, r.grass_high) << r.band;
    EXPECT_GT(sea, r.sea_low) << r.band;
    EXPECT_LT(sea, r.sea_high) << r.band;
  }
  const std::vector<double> warm = thermal.read_lines(9, 1), sea = thermal.read_lines(1, 1);
  EXPECT_NEAR(warm[12 * 2], 294.3, 1.5);
  EXPECT_NEAR(sea[2], 290.8, 1.5);
  EXPECT_NEAR(warm[12 * 2 + 1], 270.4, 4);
}

// The island's own light in the air above it; traced air: 0.448 +- 0.010 and 0.256 +- 0.005.
TEST_F(CoastFromSpace, IslandsShineIntoTheirAir) {
  render("out", "--paths 256");
  const std::vector<double> middle = EnviImage(folder_ / "out/solar.img").read_lines(9, 1);
  EXPECT_NEAR(middle[12 * kBands + 4], 0.460, 0.025);
  EXPECT_NEAR(middle[12 * kBands + 6], 0.258, 0.009);
}

TEST_F(CoastFromSpace, IsTheGroundWithoutIt) {
  render("bare", "--paths 4 --set atmosphere=null");
  EXPECT_NEAR(EnviImage(folder_ / "bare/solar.img").read_lines(9, 1)[12 * kBands + 4], 0.488, 0.002);
}

// In numbers: the direct and the diffuse light of a summer's forenoon.
TEST_F(CoastFromSpace, HasAirThatIsTold) {
  const CommandResult told = run("dirsig-render sim.yaml --air");
  ASSERT_EQ(told.code, 0) << told.err;
  double transmittance = 0, scattering = 0, direct = 0, diffuse = 0;
  const size_t green = told.out.find("green");
  ASSERT_NE(green, std::string::npos) << told.out;
  ASSERT_EQ(std::sscanf(told.out.c_str() + green, "green %*g um %lg %lg %lg %lg", &transmittance, &scattering, &direct,
                        &diffuse),
            4);
  // Depths: molecules 0.09, ozone 0.03, maritime aerosol of this visibility 0.2 to 0.28.
  EXPECT_NEAR(transmittance, 0.69, 0.03);
  EXPECT_NEAR(scattering, 0.33, 0.04);
  EXPECT_GT(direct, 1000);
  EXPECT_LT(direct, 1400);
  EXPECT_GT(diffuse, 200);
  EXPECT_LT(diffuse, 500);
  EXPECT_EQ(run("dirsig-render sim.yaml --air --set atmosphere=null").code, 1);
}

}  // namespace
}  // namespace suite
