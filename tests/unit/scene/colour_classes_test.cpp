// Classes of colours: means of their texels, no more of them than asked for or than there are colours.
#include "scene/colour_classes.h"

#include <gtest/gtest.h>

#include "math/sampling.h"

namespace suite::colour_classes_test {
namespace {

TEST(ColourClasses, AFewColoursAreTheirOwnClasses) {
  const std::vector<float> display{1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1};
  const ColourClasses found = classify_colours(display, 10);
  ASSERT_EQ(found.colours.size(), 3u);
  EXPECT_EQ(found.number[0], found.number[2]);
  EXPECT_NE(found.number[0], found.number[1]);
  EXPECT_NEAR(found.worst, 0, 1e-9);
  EXPECT_EQ(found.colours[found.number[3]], (LinearRgb{0, 0, 1}));
}

TEST(ColourClasses, KeepTheMeanAndComeCloserTheMoreTheyAre) {
  std::vector<float> display;
  Pcg32 random(7);
  for (int i = 0; i < 30000; ++i) display.push_back(static_cast<float>(random.uniform()));
  double before = 1;
  for (const size_t most : {1, 8, 64, 512}) {
    const ColourClasses found = classify_colours(display, most);
    EXPECT_EQ(found.colours.size(), most);
    EXPECT_LT(found.rms, 0.7 * before);
    before = found.rms;
    LinearRgb mean{}, of_classes{};
    for (size_t i = 0; i < display.size(); ++i) mean[i % 3] += linear_from_srgb(double{display[i]});
    for (const uint16_t k : found.number)
      for (size_t c = 0; c < 3; ++c) of_classes[c] += found.colours[k][c];
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(of_classes[c] / mean[c], 1, 1e-9);
  }
}

TEST(ColourClasses, OfNothingAreNone) { EXPECT_TRUE(classify_colours({}, 5).colours.empty()); }

}  // namespace
}  // namespace suite::colour_classes_test
