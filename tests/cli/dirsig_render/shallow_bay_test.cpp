// A shallow bay from the air: remote-sensing reflectance of its kinds of bottom, and glint, in the bounds of expect.md.
#include <cmath>

#include "math/stats.h"
#include "support/sample_kit.h"

namespace suite::shallow_bay_test {
namespace {

constexpr size_t kBands = 8, kGreen = 2, kNir = 6;

class ShallowBay : public SampleScene {
 protected:
  ShallowBay() : SampleScene("shallow_bay") {}
  // The aircraft's picture in a quarter of the columns and rows.
  void look(const std::string& out, const std::string& options) {
    render(out,
           "--set sensors.0.rows=1 --set sensors.0.columns=1 --set sensors.0.paths=1 --set sensors.1.columns=16 "
           "--set sensors.1.rows=12 --set sensors.1.pitch_um=40 " +
               options);
  }
  RunningStats part(const std::string& out, size_t channel, size_t band, size_t from, size_t to) {
    RunningStats stats;
    for (size_t row = 0; row < 12; ++row)
      for (size_t column = from; column < to; ++column)
        stats.add(value(out + "/aircraft.img", column, row, channel * kBands + band));
    return stats;
  }
};

TEST_F(ShallowBay, HasTheReflectanceOfItsBottom) {
  look("out", "--set sensors.1.paths=24");
  const EnviHeader h = read_envi_header(folder_ / "out/aircraft.img");
  EXPECT_EQ(h.data_units, "1/sr");
  EXPECT_EQ(h.band_names.size(), 4 * kBands);
  const RunningStats green = part("out", 1, kGreen, 0, 16), nir = part("out", 1, kNir, 0, 16);
  std::printf("remote-sensing reflectance, green %.5f +- %.5f, near infrared %.6f 1/sr\n", green.mean(),
              green.stderr_of_mean(), nir.mean());
  EXPECT_GT(green.mean(), 0.012);
  EXPECT_LT(green.mean(), 0.026);
  EXPECT_LT(nir.mean(), 0.03 * green.mean()) << "water is black there";
  EXPECT_EQ(part("out", 2, kGreen, 0, 16).mean(), 0) << "no wave of these is steep enough";
  // The sky in flat water, 2 % of its radiance.
  EXPECT_NEAR(part("out", 3, kGreen, 0, 16).mean(), 0.0013, 0.0004);
}

TEST_F(ShallowBay, GlitterIsOnTheSideOfTheSun) {
  const CommandResult r =
      run("scene-prep scene.yaml -o rough.h5 --set materials.surface.model=ggx_dielectric --set "
          "materials.surface.roughness=0.15");
  ASSERT_EQ(r.code, 0) << r.err;
  look("glint", "--set scene=rough.h5 --set sensors.1.paths=8");
  const RunningStats away = part("glint", 2, kGreen, 0, 5), towards = part("glint", 2, kGreen, 11, 16);
  std::printf("glint, green: west %.5f, east %.5f 1/sr\n", away.mean(), towards.mean());
  EXPECT_GT(towards.mean(), 1.3 * away.mean());
  EXPECT_NEAR(part("glint", 2, kGreen, 0, 16).mean(), 0.0025, 0.0005);
}

}  // namespace
}  // namespace suite::shallow_bay_test
