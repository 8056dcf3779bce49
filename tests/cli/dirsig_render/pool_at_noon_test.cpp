// A pool whose floor shows caustics: waves move the sun's light about, and lose none of it.
#include <algorithm>
#include <cmath>

#include "math/stats.h"
#include "support/sample_kit.h"

namespace suite::pool_at_noon_test {
namespace {

class PoolAtNoon : public SampleScene {
 protected:
  PoolAtNoon() : SampleScene("pool_at_noon") {}
  // The floor between the lines, 40 x 12 pixels of 5 cm.
  RunningStats floor(const std::string& out, const std::string& scene) {
    render(out, "--set scene=" + scene +
                    " --set sensors.0.rows=1 --set sensors.0.columns=1 --set sensors.0.paths=1 --set "
                    "sensors.1.columns=40 --set sensors.1.rows=12 --set sensors.1.paths=32");
    RunningStats stats;
    for (size_t row = 0; row < 12; ++row)
      for (size_t column = 0; column < 40; ++column) stats.add(value(out + "/floor.img", column, row, 0));
    return stats;
  }
};

TEST_F(PoolAtNoon, WavesMoveTheLightAndKeepIt) {
  const CommandResult r = run(
      "scene-prep scene.yaml -o flat.h5 --set 'objects.surface={plane: {width: 8.1, depth: 5.1}, material: surface}'");
  ASSERT_EQ(r.code, 0) << r.err;
  const RunningStats waves = floor("waves", "scene.h5"), flat = floor("flat", "flat.h5");
  const double pattern = std::sqrt(waves.variance()) / waves.mean(), noise = std::sqrt(flat.variance()) / flat.mean();
  std::printf("floor: %.1f W/(m2 sr um), varies by %.1f %%; under flat water %.1f, %.1f %%\n", waves.mean(),
              100 * pattern, flat.mean(), 100 * noise);
  EXPECT_GT(pattern, 0.25);
  EXPECT_LT(pattern, 0.75);
  EXPECT_LT(noise, 0.1) << "control: without waves there is no pattern";
  // 480 pixels of a pattern some 30 cm wide: some 13 meshes; and a noise of their own.
  EXPECT_NEAR(waves.mean(), flat.mean(), 0.1 * flat.mean());
}

}  // namespace
}  // namespace suite::pool_at_noon_test
