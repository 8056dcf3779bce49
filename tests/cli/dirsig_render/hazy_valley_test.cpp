// A hazy valley under low sun: shadows of ridges in the haze, by air that is traced and by the field with what paths
// find of the scene, and those of clouds, in the bounds of expect.md of the sample.
#include <gmock/gmock.h>

#include "support/sample_kit.h"

namespace suite::hazy_valley_test {
namespace {

class HazyValley : public SampleScene {
 protected:
  HazyValley() : SampleScene("hazy_valley") {}
  void SetUp() override {
    SampleScene::SetUp();
    ASSERT_EQ(run("scene-prep scene.yaml -o empty.h5 --set 'volumes=[]' --set 'grids={}' --set 'media={}'").code, 0);
  }
  // A quarter of the columns and rows.
  void render_quarter(const std::string& to, const std::string& options) {
    render(to, options + " --set sensors.0.columns=24 --set sensors.0.rows=14 --set sensors.0.pitch_um=250");
  }
  // The mean of a band over rows and columns, up to the last ones.
  double mean(const std::string& to, size_t band, size_t row, size_t rows, size_t column, size_t columns) {
    double sum = 0;
    for (size_t r = row; r < rows; ++r)
      for (size_t c = column; c < columns; ++c) sum += value(to + "/slope.img", c, r, band);
    return sum / static_cast<double>((rows - row) * (columns - column));
  }
  double sky(const std::string& to, size_t band) { return mean(to, band, 0, 3, 0, 24); }
  double haze(const std::string& to, size_t band) { return mean(to, band, 5, 9, 6, 19); }
};

constexpr const char* kField = " --set atmosphere.scattering=diffuse --set atmosphere.ground_albedo=0.045";

TEST_F(HazyValley, ShadowsStandInItsAir) {
  render_quarter("clouds", "--paths 200");
  render_quarter("empty", "--paths 200 --set scene=empty.h5");
  render_quarter("field", std::string("--paths 64 --set scene=empty.h5") + kField);
  render_quarter("beside", std::string("--paths 64") + kField);
  render_quarter("even", std::string("--paths 8 --set scene=empty.h5 --set atmosphere.adjacency=false") + kField);
  for (size_t band = 0; band < 3; ++band) {
    const double clouds = haze("clouds", band) / haze("empty", band);
    std::printf("band %zu, by paths scattered in the air: sky %.3f of the field's, haze %.3f; clouds leave %.3f\n",
                band, sky("empty", band) / sky("field", band), haze("empty", band) / haze("field", band), clouds);
    // Standard errors are 0.6 and 1.5 %.
    EXPECT_NEAR(sky("field", band) / sky("empty", band), 1, 0.02) << band;
    EXPECT_NEAR(haze("field", band) / haze("empty", band), 1, 0.05) << band;
    EXPECT_NEAR(sky("beside", band) / sky("clouds", band), 1, 0.02) << band;
    EXPECT_NEAR(haze("beside", band) / haze("clouds", band), 1, 0.06) << band << ": the clouds' shadows";
    EXPECT_LT(haze("field", band) / haze("even", band), 0.94) << band << ": the ridges' shadows";
    EXPECT_NEAR(clouds, 0.89, 0.07) << band;
    EXPECT_NEAR(sky("clouds", band) / sky("empty", band), 1, 0.02) << band;
  }
}

// The field's paths find the shadows of ridges and clouds, and nothing is said to be left out.
TEST_F(HazyValley, TheFieldLeavesNoShadowsOut) {
  const CommandResult r = run_command("cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/dirsig-render sim.yaml --air" +
                                      std::string(kField));
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, testing::Not(testing::HasSubstr("left out, as media")));
  EXPECT_THAT(r.err, testing::HasSubstr("adjacency            used"));
}

// Where paths meet media and air on one way, what the air adds alone is not known: it was an image of zeros.
TEST_F(HazyValley, PathRadianceIsRefusedAmongMedia) {
  const CommandResult r =
      run_command("cd '" + folder_.path() +
                  "' && " SUITE_BIN_DIR "/dirsig-render sim.yaml -o parts --set 'sensors.0.channels=[path_radiance]'" +
                  std::string(kField));
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, testing::HasSubstr("path_radiance, which is not known apart where media fill the scene"));
}

}  // namespace
}  // namespace suite::hazy_valley_test
