// Spectra from display colours show these colours. Held against the CIE 1931 observer and D65 (tests/data/colour), with
// sRGB's own matrix (IEC 61966-2-1, four decimals): XYZ of the spectrum under D65, scaled to Y = 1 for white.
#include "spectral/display_colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/files.h"

namespace suite::display_colour_test {
namespace {

struct Row {
  double um = 0;
  std::array<double, 4> xyz_d65{};
};

std::vector<Row> observer() {
  std::istringstream text(read_text(SUITE_SOURCE_DIR "/tests/data/colour/cie_1nm.csv"));
  std::string line;
  std::getline(text, line);
  std::vector<Row> rows;
  while (std::getline(text, line)) {
    std::istringstream cells(line);
    Row r;
    char comma = 0;
    cells >> r.um;
    for (double& v : r.xyz_d65) cells >> comma >> v;
    r.um *= 1e-3;
    rows.push_back(r);
  }
  return rows;
}

// The linear colour that a reflectance shows.
LinearRgb seen(const Curve& reflectance) {
  static const std::vector<Row> rows = observer();
  std::array<double, 3> xyz{};
  double white = 0;
  for (const Row& r : rows) {
    white += r.xyz_d65[1] * r.xyz_d65[3];
    for (size_t k = 0; k < 3; ++k) xyz[k] += r.xyz_d65[k] * r.xyz_d65[3] * reflectance.at(r.um);
  }
  static constexpr double kMatrix[3][3] = {
      {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
  LinearRgb rgb{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) rgb[i] += kMatrix[i][k] * xyz[k] / white;
  return rgb;
}

// In levels of 255, the farthest channel.
double off(const LinearRgb& display, const Curve& reflectance) {
  const LinearRgb back = seen(reflectance);
  double worst = 0;
  for (size_t c = 0; c < 3; ++c) worst = std::max(worst, 255 * std::fabs(srgb_from_linear(back[c]) - display[c]));
  return worst;
}

Curve of_display(const LinearRgb& display) {
  return uplifted({linear_from_srgb(display[0]), linear_from_srgb(display[1]), linear_from_srgb(display[2])});
}

TEST(DisplayColour, ComesBackFromItsSpectrum) {
  constexpr double kStated = 0.4;  // levels of 255, as the header says
  for (int r = 0; r <= 255; r += 15)
    for (int g = 0; g <= 255; g += 15)
      for (int b = 0; b <= 255; b += 15) {
        const LinearRgb display{r / 255.0, g / 255.0, b / 255.0};
        ASSERT_LT(off(display, of_display(display)), kStated) << r << " " << g << " " << b;
      }
  // Flat parts with ramps between them, as blue, green and red filters would be cut, do not show their colour.
  const Curve flat({0.38, 0.485, 0.505, 0.575, 0.6, 0.78}, {0, 0, 1, 1, 0, 0}, Outside::hold);
  EXPECT_GT(off({0, 1, 0}, flat), 20);
}

TEST(DisplayColour, IsBoundedAndNeutralForGrey) {
  for (const LinearRgb& c : {LinearRgb{0, 0, 0}, {1, 1, 1}, {1, 0, 1}, {0.2, 0.7, 0.05}, {1.5, -0.2, 0.5}})
    for (const double v : uplifted_values(c)) {
      EXPECT_GE(v, std::max(0.0, std::min({c[0], c[1], c[2]})));
      EXPECT_LE(v, std::min(1.0, std::max({c[0], c[1], c[2]})));
    }
  for (const double v : uplifted_values({0.18, 0.18, 0.18})) EXPECT_DOUBLE_EQ(v, 0.18);
}

TEST(DisplayColour, HoldsItsEndsBeyondTheVisible) {
  const Curve red = uplifted({0.6, 0.1, 0.1});
  EXPECT_TRUE(red.covers(0.3, 2.5));
  EXPECT_DOUBLE_EQ(red.at(1.6), red.at(0.78));
  EXPECT_DOUBLE_EQ(red.at(0.3), red.at(0.38));
}

TEST(DisplayColour, TransferIsItsOwnInverse) {
  for (int i = 0; i <= 255; ++i) EXPECT_NEAR(srgb_from_linear(linear_from_srgb(i / 255.0)), i / 255.0, 2e-6);
}

}  // namespace
}  // namespace suite::display_colour_test
