// A Landsat-like push-broom over real relief, from its script to its images: how far bands and chips stand apart is
// measured by matching their pictures and compared with what geometry and the heights say.
//
// Matching: least squares over a shift along the track, a gain and an offset, Gauss-Newton, cubic convolution between
// lines. Based on: R. Keys, "Cubic convolution interpolation for digital image processing", IEEE Trans. ASSP 29, 1981.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/run_command.h"

namespace suite::landsat_like_test {
namespace {

// The design of sample_scenes/landsat_like/make_inputs.py.
constexpr double kHeight = 705000, kFocal = 1.41, kPerLine = 5;
constexpr int kChips = 7, kChip = 10, kOverlap = 4;
const char* kBands[] = {"coastal", "blue", "green", "red", "nir", "swir1", "swir2", "pan", "cirrus"};
double ahead(int band, int chip) { return (4 - band) * 3e-3 + (chip % 2 ? -2e-3 : 2e-3); }

struct Picture {
  size_t lines = 0, columns = 0;
  std::vector<double> grey, up;  // radiance; height, NaN where nothing was hit
  double at(size_t l, size_t c) const { return grey[l * columns + c]; }
};
Picture read(const std::string& folder, const std::string& band) {
  const EnviImage image(folder + "/oli_" + band + ".img"), truth(folder + "/oli_" + band + "_truth.img");
  Picture p;
  p.columns = image.header().samples, p.lines = image.header().lines;
  p.grey = image.read_all();
  const std::vector<double> t = truth.read_all();
  for (size_t i = 0; i < p.lines * p.columns; ++i) p.up.push_back(t[3 * i + 2]);
  return p;
}

// Value and slope of a column at a place between lines.
struct Between {
  double value = NAN, slope = NAN;
};
Between between(const Picture& p, double line, size_t column) {
  const double whole = std::floor(line), t = line - whole;
  if (whole < 1 || whole + 2 >= static_cast<double>(p.lines)) return {};
  const size_t l = static_cast<size_t>(whole);
  for (size_t i = l - 1; i <= l + 2; ++i)
    if (std::isnan(p.up[i * p.columns + column])) return {};
  const double a = p.at(l - 1, column), b = p.at(l, column), c = p.at(l + 1, column), d = p.at(l + 2, column);
  const double k1 = (c - a) / 2, k2 = a - 2.5 * b + 2 * c - d / 2, k3 = (d - a) / 2 + 1.5 * (b - c);
  return {b + t * (k1 + t * (k2 + t * k3)), k1 + t * (2 * k2 + 3 * t * k3)};
}

// Solves a symmetric 3 x 3 system.
std::array<double, 3> solve(std::array<std::array<double, 4>, 3> m) {
  for (int i = 0; i < 3; ++i)
    for (int r = 0; r < 3; ++r) {
      if (r == i) continue;
      const double f = m[r][i] / m[i][i];
      for (int c = 0; c < 4; ++c) m[r][c] -= f * m[i][c];
    }
  return {m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]};
}

struct Window {
  size_t line, lines, column, columns;  // in the first picture
};
struct Match {
  double shift = NAN;   // lines from the first picture to the second
  double height = NAN;  // m, of what was matched, weighted as the match weighs it
};
// start: where to begin, lines. columns_on: how far the columns of the second picture are on.
Match match(const Picture& first, const Picture& second, const Window& w, double start, long columns_on = 0) {
  double shift = start, gain = 1, offset = 0, height = 0, weight = 0;
  for (int round = 0; round < 20; ++round) {
    std::array<std::array<double, 4>, 3> m{};
    height = weight = 0;
    for (size_t l = w.line; l < w.line + w.lines; ++l)
      for (size_t c = w.column; c < w.column + w.columns; ++c) {
        const double wanted = first.at(l, c), up = first.up[l * first.columns + c];
        const Between b =
            between(second, static_cast<double>(l) + shift, static_cast<size_t>(static_cast<long>(c) + columns_on));
        if (std::isnan(b.value) || std::isnan(up)) return {};
        const double row[] = {gain * b.slope, b.value, 1}, left = wanted - gain * b.value - offset;
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) m[static_cast<size_t>(i)][static_cast<size_t>(j)] += row[i] * row[j];
          m[static_cast<size_t>(i)][3] += row[i] * left;
        }
        height += b.slope * b.slope * up, weight += b.slope * b.slope;
      }
    if (!(weight > 0)) return {};
    const std::array<double, 3> step = solve(m);
    shift += step[0], gain += step[1], offset += step[2];
    if (std::fabs(shift - start) > 6) return {};  // wandered off to another patch
    if (std::fabs(step[0]) < 1e-4) return {shift, height / weight};
  }
  return {};
}

struct Tally {
  int n = 0, lost = 0;
  double worst = 0, square = 0, flat = 0, low = INFINITY, high = -INFINITY;
  // expected(height): lines; start: what it would be over level ground.
  template <class Expected>
  void add(const Match& m, const Expected& expected, double mean_height) {
    if (std::isnan(m.shift)) return void(++lost);
    const double off = m.shift - expected(m.height);
    ++n, square += off * off, worst = std::max(worst, std::fabs(off));
    flat = std::max(flat, std::fabs(m.shift - expected(mean_height)));
    low = std::min(low, m.height), high = std::max(high, m.height);
  }
  void print(const char* what) const {
    std::printf(
        "%s: %d windows (%d not matched), ground at %.0f to %.0f m: predicted to %.3f pixels rms, %.3f at most; level "
        "ground would be off by up to %.2f\n",
        what, n, lost, low, high, std::sqrt(square / n), worst, flat);
  }
};

TEST(LandsatLike, ParallaxAndStaggerSeenInTheImagesAreThoseOfTheRelief) {
  if (run_command("command -v python3").code != 0) GTEST_SKIP() << "python3 is not installed";
  const TempFolder folder;
  const CommandResult r =
      run_command("export PATH='" SUITE_BIN_DIR "':$PATH && '" SUITE_SOURCE_DIR "/sample_scenes/landsat_like/run' '" +
                  folder.path() + "'");
  ASSERT_EQ(r.code, 0) << r.out << r.err;
  std::vector<Picture> bands;
  for (const char* name : kBands) bands.push_back(read(folder / "out", name));
  ASSERT_EQ(bands[0].columns, static_cast<size_t>(kChips * kChip));
  double mean = 0, hits = 0;
  for (const double h : bands[4].up)
    if (!std::isnan(h)) mean += h, ++hits;
  mean /= hits;

  constexpr size_t kLines = 40;  // 200 m
  Tally parallax, stagger;
  const Picture& first = bands[0];
  for (int chip = 0; chip < kChips; ++chip)
    for (size_t line = 1; line + kLines < first.lines; line += kLines / 2) {
      const size_t column = static_cast<size_t>(chip * kChip);
      if (std::isnan(first.up[line * first.columns + column])) continue;
      for (int b = 1; b < 9; ++b) {
        auto expected = [&](double h) { return (ahead(0, chip) - ahead(b, chip)) / kFocal * (kHeight - h) / kPerLine; };
        parallax.add(match(first, bands[static_cast<size_t>(b)], {line, kLines, column, kChip}, expected(mean)),
                     expected, mean);
      }
      if (chip + 1 == kChips) continue;
      // The last columns of a chip see the ground that the first of the next one see.
      auto expected = [&](double h) {
        return (ahead(0, chip) - ahead(0, chip + 1)) / kFocal * (kHeight - h) / kPerLine;
      };
      stagger.add(match(first, first, {line, kLines, column + kChip - kOverlap, kOverlap}, expected(mean), kOverlap),
                  expected, mean);
    }
  parallax.print("bands against the first");
  stagger.print("chips against their neighbours");
  EXPECT_GT(parallax.n, 500);
  EXPECT_LT(parallax.lost, parallax.n / 5);  // windows that leave the terrain
  EXPECT_LT(parallax.worst, 0.1);
  EXPECT_GT(parallax.flat, 0.5);  // and relief is what it is about
  EXPECT_GT(stagger.n, 100);
  EXPECT_LT(stagger.worst, 0.1);
}

}  // namespace
}  // namespace suite::landsat_like_test
