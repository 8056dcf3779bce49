// A car behind its windscreen: seen through in the visible, opaque and warm where glass absorbs.
#include <cmath>

#include "math/stats.h"
#include "support/sample_kit.h"

namespace suite::windscreen_test {
namespace {

class Windscreen : public SampleScene {
 protected:
  Windscreen() : SampleScene("windscreen") {}
  // Mean and spread of a block of pixels.
  RunningStats block(const std::string& picture, size_t column, size_t row, size_t band = 0) {
    RunningStats stats;
    for (size_t j = 0; j < 5; ++j)
      for (size_t i = 0; i < 5; ++i) stats.add(value(picture, column + i, row + j, band));
    return stats;
  }
};

TEST_F(Windscreen, IsClearInTheVisibleAndWarmInTheInfrared) {
  render("out", "--set sensors.0.paths=8 --set sensors.1.paths=16");
  // The driver's shirt, and the dark between the seats.
  const RunningStats shirt = block("out/visible.img", 56, 22, 1), dark = block("out/visible.img", 46, 20, 1);
  std::printf("visible: shirt %.1f +- %.1f, between the seats %.1f +- %.1f W/(m2 sr um)\n", shirt.mean(),
              shirt.stderr_of_mean(), dark.mean(), dark.stderr_of_mean());
  EXPECT_GT(shirt.mean(), 2 * dark.mean());
  EXPECT_GT(shirt.mean() - dark.mean(), 4 * std::hypot(shirt.stderr_of_mean(), dark.stderr_of_mean()));
  const RunningStats there = block("out/thermal.img", 56, 22), beside = block("out/thermal.img", 46, 20);
  std::printf("4.55 um: %.2f +- %.2f K, %.2f +- %.2f K\n", there.mean(), there.stderr_of_mean(), beside.mean(),
              beside.stderr_of_mean());
  // The sky in the mirror of the glass is not the same ten columns apart: 0.02 K, seen since paths follow it beside
  // what the glass lets through (noise was 0.1 K).
  EXPECT_NEAR(there.mean(), beside.mean(), 0.05 + 4 * std::hypot(there.stderr_of_mean(), beside.stderr_of_mean()));
  // Glass at 318 K of emissivity 1 - R, R = 0.066 at 55 degrees, before a sky that is colder: 1.3 to 1.8 K less.
  EXPECT_NEAR(there.mean(), 316.4, 0.4 + 4 * there.stderr_of_mean());
  // Control: through clear glass the shirt of 304 K would be seen.
  EXPECT_GT(there.mean() - 304, 10 * there.stderr_of_mean());
}

}  // namespace
}  // namespace suite::windscreen_test
