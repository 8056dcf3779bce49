// A valley by starlight: the numbers of expect.md of the sample.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>

#include "base/files.h"
#include "support/sample_kit.h"

namespace suite::starlit_valley_test {
namespace {

class StarlitValley : public SampleScene {
 protected:
  StarlitValley() : SampleScene("starlit_valley") {}
};

TEST_F(StarlitValley, ShowsWhatIsExpected) {
  // A quarter of the columns and rows over the same ground.
  render("out", "--paths 32 --set sensors.0.columns=160 --set sensors.0.rows=100 --set sensors.0.pitch_um=60");
  // Dubhe, in pixels of 640 x 400; a star is listed in the middle of its pixel.
  const std::string table = read_text(folder_ / "out/valley_stars.csv");
  size_t number = 0;
  double column = 0, row = 0, green = 0;
  for (size_t at = table.find('\n', table.find("name,")) + 1; at < table.size(); at = table.find('\n', at) + 1) {
    ++number;
    if (table.compare(at, 5, "4301,") == 0) break;
  }
  const size_t dubhe = table.find("\n4301,");
  ASSERT_NE(dubhe, table.npos);
  ASSERT_EQ(std::sscanf(table.c_str() + dubhe, "\n4301,1.79,%lf,%lf,%*f,%lf", &column, &row, &green), 3);
  EXPECT_NEAR(4 * column, 191.5, 4);
  EXPECT_NEAR(4 * row, 108.5, 4);
  // Averaged over a band of 0.09 um: within a few per cent of V's irradiance.
  const double v = 3.631e-8 * std::pow(10, -0.4 * 1.79);
  EXPECT_NEAR(green, v, 0.05 * v);
  const auto c = static_cast<size_t>(column), r = static_cast<size_t>(row);
  EXPECT_EQ(value("out/valley_truth.img", c, r, 0), static_cast<double>(number));
  // The meadow against the sky over the ridge, without the stars' own pixels.
  const auto mean = [&](size_t first, size_t last, size_t line) {
    double sum = 0, n = 0;
    for (size_t x = first; x < last; ++x)
      if (value("out/valley_truth.img", x, line, 0) == 0) sum += value("out/valley.img", x, line, 1), ++n;
    return sum / n;
  };
  const double contrast = mean(75, 85, 45) / mean(20, 60, 88);
  EXPECT_GT(contrast, 15);
  EXPECT_LT(contrast, 30);
}

}  // namespace
}  // namespace suite::starlit_valley_test
