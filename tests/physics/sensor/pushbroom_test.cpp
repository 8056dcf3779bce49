// A Landsat-like push-broom from 705 km over relief: seven staggered sub-chip assemblies, nine bands in rows of their
// own. Each place is seen by the bands one after the other and from other directions, so that relief shifts the bands
// against each other (parallax).
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "support/platform_kit.h"

namespace suite::pushbroom_test {
namespace {

using test::PlatformKit;

constexpr double kHeight = 705000, kFocal = 1.41, kPitch = 10e-6, kSpeed = 7500;
constexpr int kChip = 3, kChips = 7;

// Terrain between 78 and 451 m with waves of some hundred metres, textured by its class in stripes across the track.
double relief(double x, double y) { return 264.5 + 186.5 * std::sin(x / 170) * std::cos(y / 230); }
std::shared_ptr<Scene> terrain() {
  const int n = 241;
  const double step = 10, half = 1200;
  std::vector<Vec3> v;
  std::vector<uint32_t> f;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      v.push_back({i * step - half, j * step - half, relief(i * step - half, j * step - half)});
  for (uint32_t j = 0; j + 1 < n; ++j)
    for (uint32_t i = 0; i + 1 < n; ++i)
      for (const uint32_t k :
           {j * n + i, j * n + i + 1, (j + 1) * n + i + 1, j * n + i, (j + 1) * n + i + 1, (j + 1) * n + i})
        f.push_back(k);
  return test::scene_of({test::mesh_of(v, f, 0)}, {test::material("ground", test::lambert(0.3))});
}

// Offset of a band's row ahead of the middle of its chip, and of the chips, alternating; m in the focal plane.
double band_ahead(int band) { return (4 - band) * 3e-3; }
double chip_ahead(int chip) { return chip % 2 ? -4e-3 : 4e-3; }

std::string broom() {
  std::string arrays;
  for (int b = 0; b < 9; ++b) {
    arrays += strf(
        "      - name: b%d\n        pitch_um: 10\n        integration_time_s: 0\n        readout: {kind: line, "
        "line_rate_hz: 1500, lines_per_capture: 512}\n        paths: 16\n        bands: [{name: b%d, center_um: %g, "
        "fwhm_um: 0.02}]\n        chips:\n",
        b, b, 0.45 + 0.1 * b);
    for (int c = 0; c < kChips; ++c)
      arrays += strf("          - {columns: %d, offset_mm: [%g, %g]}\n", kChip, (c - 3) * kChip * kPitch * 1e3,
                     (chip_ahead(c) + band_ahead(b)) * 1e3);
  }
  // From 9.5 km before to 9.5 km behind: the rows look up to 8 km ahead or behind.
  return strf(
             "kind: platform\nmotion: {kind: straight, position_m: [0, -9500, %g], heading_deg: 0, speed_m_s: "
             "%g}\ntasks: [{start: 0, stop: 2.5333334}]\ntruth: [location]\ninstruments:\n  - focal_length_mm: 1410\n  "
             "  arrays:\n",
             kHeight, kSpeed) +
         arrays;
}

// North and height of every pixel, by line and column; of every band.
struct Seen {
  double north, up;
};
using Lines = std::vector<std::vector<Seen>>;
using SeenByBand = std::map<int, Lines>;
SeenByBand seen_by_band(const PlatformKit& kit) {
  SeenByBand of;
  for (const test::Shot& s : kit.shots) {
    auto& lines = of[s.rows.image.back() - '0'];
    EXPECT_EQ(s.result.columns, static_cast<uint32_t>(kChip * kChips));
    lines.resize(s.rows.rows_of_task);
    for (uint32_t r = 0; r < s.result.rows; ++r)
      for (uint32_t c = 0; c < s.result.columns; ++c) {
        const double* t = &s.result.truth[(size_t{r} * s.result.columns + c) * 3];
        lines[s.rows.row_in_task + r].push_back({t[1], t[2]});
      }
  }
  return of;
}
// The line at which a band sees a place: where its ground track passes it, between two lines.
double line_of(const Lines& lines, size_t column, double north) {
  for (size_t l = 1; l < lines.size(); ++l) {
    const double a = lines[l - 1][column].north, b = lines[l][column].north;
    if (a <= north && north < b) return static_cast<double>(l) - 1 + (north - a) / (b - a);
  }
  return std::nan("");
}

TEST(PushBroom, ParallaxOfTheBandsIsThatOfTheRelief) {
  PlatformKit kit;
  SourceSpecs sources;
  sources.add(test::uniform_sky(1, false));
  kit.render(terrain(), sources, broom());
  const SeenByBand of = seen_by_band(kit);
  ASSERT_EQ(of.size(), 9u);
  const double gsd = kPitch / kFocal * kHeight, per_line = kSpeed / 1500;
  double worst = 0, largest = 0, lowest = INFINITY, highest = -INFINITY;
  int n = 0;
  for (const size_t column : {size_t{1}, size_t{1 + kChip}, size_t{2 + 3 * kChip}, size_t{6 * kChip}}) {
    const int chip = kChips - 1 - static_cast<int>(column) / kChip;  // the last chip, on the right, comes first
    for (const int band : {1, 4, 8})
      for (double north = -700; north <= 700; north += 70) {
        const double first = line_of(of.at(0), column, north), later = line_of(of.at(band), column, north);
        if (std::isnan(first) || std::isnan(later)) continue;
        // Seen at heights h: band b stands kHeight - h above it, and sees it (offset / f)(kHeight - h) ahead. Place and
        // height are interpolated like the line itself.
        const auto& l0 = of.at(0)[static_cast<size_t>(first)][column];
        const double h = l0.up;
        const double angle_first = (chip_ahead(chip) + band_ahead(0)) / kFocal,
                     angle_later = (chip_ahead(chip) + band_ahead(band)) / kFocal;
        const double expected = (angle_first - angle_later) * (kHeight - h) / per_line;
        const double flat = (angle_first - angle_later) * kHeight / per_line;
        const double slope = std::fabs(l0.up - of.at(0)[static_cast<size_t>(first) + 1][column].up);
        if (slope > 3) continue;  // on steep slopes the height between two lines is not that of either
        worst = std::max(worst, std::fabs(later - first - expected));
        largest = std::max(largest, std::fabs(flat - expected));
        lowest = std::min(lowest, h), highest = std::max(highest, h);
        ++n;
      }
  }
  std::printf(
      "%d places at heights of %.0f to %.0f m, %.3f m pixels, %.3f m lines: parallax up to %.2f lines, predicted to "
      "%.3f lines\n",
      n, lowest, highest, gsd, per_line, largest, worst);
  EXPECT_GT(n, 100);
  EXPECT_GT(largest, 1);
  EXPECT_LT(worst, 0.1);
}

}  // namespace
}  // namespace suite::pushbroom_test
