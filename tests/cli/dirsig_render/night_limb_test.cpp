// The night side from orbit: the numbers of expect.md of the sample.
#include <cmath>

#include "support/sample_kit.h"

namespace suite::night_limb_test {
namespace {

class NightLimb : public SampleScene {
 protected:
  NightLimb() : SampleScene("night_limb") {}
};

TEST_F(NightLimb, ShowsWhatIsExpected) {
  render("out",
         "--paths 16 --set sensors.0.columns=16 --set sensors.0.rows=400 --set sensors.0.pitch_um=15 --set "
         "night_sky.resolve_stars=none");
  double most = 0;
  size_t at = 0;
  for (size_t row = 0; row < 400; ++row)
    if (const double green = value("out/limb.img", 2, row, 1); green > most) most = green, at = row;
  // The camera looks down by atan(0.295), and the line from 410 km to 92 km over the equator's sphere is at acos of
  // (R + 92) / (R + 410), in the middle of the frame but for the flattening.
  const double down = std::acos((6371.0 + 92) / (6371.0 + 410)), looks = std::atan(0.295);
  EXPECT_NEAR(static_cast<double>(at), 200 + std::tan(down - looks) * 12 / 0.015, 6);
  const double ground = value("out/limb.img", 2, 395, 1), sky = value("out/limb.img", 2, 5, 1);
  EXPECT_GT(most / ground, 5);
  EXPECT_GT(most / sky, 20);
  EXPECT_GT(ground, 0);
}

}  // namespace
}  // namespace suite::night_limb_test
