// Point spreads by the slanted edge: pictures of a black and white half plane are rendered and their modulation
// transfer function measured and compared with the product of the pattern's own and the detector's sinc. Based on: ISO
// 12233 (slanted-edge spatial frequency response), with the known instead of a fitted edge.
#include <gtest/gtest.h>

#include <cmath>

#include "support/platform_kit.h"

namespace suite::mtf_test {
namespace {

using test::PlatformKit;

constexpr double kSlope = 0.0875;  // of the edge, about 5 degrees
constexpr double kPitch = 10e-6, kHeight = 100;
constexpr int kColumns = 64, kRows = 206;

// White (reflectance 1) right of x = slope * y, nothing left of it.
std::shared_ptr<Scene> edge_scene() {
  const double s = 20;
  Mesh m = test::mesh_of({{kSlope * -s, -s, 0}, {s, -s, 0}, {s, s, 0}, {kSlope * s, s, 0}}, {0, 1, 2, 0, 2, 3}, 0);
  return test::scene_of({m}, {test::material("white", test::lambert(1))});
}

// MTF of a band at frequencies (cycles a pixel), from pixels sorted by their distance from the edge.
std::vector<double> slanted_edge(const std::vector<double>& radiance, size_t bands, size_t band,
                                 const std::vector<double>& frequency) {
  const double cosine = 1 / std::sqrt(1 + kSlope * kSlope);
  // Edge spread in bins of a quarter pixel.
  constexpr double bin = 0.25, reach = 22;
  std::vector<double> sum(static_cast<size_t>(2 * reach / bin)), count(sum.size());
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      const double x = (c + 0.5 - 0.5 * kColumns), y = (0.5 * kRows - r - 0.5), d = (x - kSlope * y) * cosine;
      const double k = std::floor((d + reach) / bin);
      if (k < 0 || k >= static_cast<double>(sum.size())) continue;
      sum[static_cast<size_t>(k)] +=
          radiance[(static_cast<size_t>(r) * kColumns + static_cast<size_t>(c)) * bands + band];
      ++count[static_cast<size_t>(k)];
    }
  std::vector<double> line;
  for (size_t k = 1; k < sum.size(); ++k) line.push_back(sum[k] / count[k] - sum[k - 1] / count[k - 1]);
  std::vector<double> mtf;
  for (const double f : frequency) {
    double re = 0, im = 0;
    for (size_t k = 0; k < line.size(); ++k) {
      const double at = (static_cast<double>(k) + 1) * bin - reach;
      re += line[k] * std::cos(2 * kPi * f * at), im += line[k] * std::sin(2 * kPi * f * at);
    }
    // The step from black to white is known to be 1. The bins' averaging and the difference are one sinc each.
    const double s = std::sin(kPi * f * bin) / (kPi * f * bin);
    mtf.push_back(std::hypot(re, im) / (s * s));
  }
  return mtf;
}

// The detector's, across an edge of this slope.
double detector_mtf(double f) {
  auto sinc = [](double x) { return std::fabs(x) < 1e-12 ? 1 : std::sin(kPi * x) / (kPi * x); };
  const double n = std::sqrt(1 + kSlope * kSlope);
  return std::fabs(sinc(f / n) * sinc(f * kSlope / n));
}

struct Case {
  const char* name;
  std::string optics, bands;
  std::vector<std::function<double(double)>> mtf;  // of each band at cycles a pixel
  int paths = 128;
};

double airy_mtf(double cycles_per_pixel, double um, double f_number) {
  const double v = cycles_per_pixel / kPitch * um * 1e-6 * f_number;
  return v >= 1 ? 0 : 2 / kPi * (std::acos(v) - v * std::sqrt(1 - v * v));
}

double worst_error(PlatformKit& kit, const Case& c) {
  const std::string text =
      strf(
          "kind: platform\nmotion: {kind: static, position_m: [0, 0, %g]}\ntasks: [{start: 0}]\ntruth: "
          "[]\ninstruments:\n  - focal_length_mm: 100\n    ",
          kHeight) +
      c.optics +
      strf("\n    arrays: [{columns: %d, rows: %d, pitch_um: 10, paths: %d, spectral_step_um: 0.02, bands: [", kColumns,
           kRows, c.paths) +
      c.bands + "]}]\n";
  SourceSpecs sources;
  sources.add(test::uniform_sky(1, false));
  kit.shots.clear();
  kit.render(edge_scene(), sources, text);
  const std::vector<double> frequency{0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5};
  double worst = 0;
  for (size_t b = 0; b < c.mtf.size(); ++b) {
    const std::vector<double> measured = slanted_edge(kit.shots.at(0).result.radiance, c.mtf.size(), b, frequency);
    for (size_t i = 0; i < frequency.size(); ++i)
      worst = std::max(worst, std::fabs(measured[i] - c.mtf[b](frequency[i]) * detector_mtf(frequency[i])));
  }
  std::printf("%-12s largest error of the MTF up to Nyquist %.4f\n", c.name, worst);
  return worst;
}

const char* const kNarrow = "{name: a, center_um: 0.6, fwhm_um: 0.01, shape: rectangular}";

TEST(Mtf, OfADetectorAlone) {
  PlatformKit kit;
  EXPECT_LT(worst_error(kit, {"detector", "throughput: 1", kNarrow, {[](double) { return 1.0; }}}), 0.01);
}

TEST(Mtf, OfAGaussian) {
  PlatformKit kit;
  auto gauss = [](double f) { return std::exp(-2 * kPi * kPi * 0.6 * 0.6 * f * f); };
  EXPECT_LT(worst_error(kit, {"gaussian", "psf: {kind: gaussian, sigma_um: 6}", kNarrow, {gauss}}), 0.01);
  // Negative control: a width that is 5 % off is seen.
  EXPECT_GT(worst_error(kit, {"control", "psf: {kind: gaussian, sigma_um: 6.3}", kNarrow, {gauss}}), 0.01);
}

TEST(Mtf, OfAnAiryPatternWhoseWidthFollowsTheWavelength) {
  // One state, one set of rays, two bands a factor of two apart: the spectral weight makes each band's pattern its own.
  PlatformKit kit;
  const Case pair{"airy",
                  "f_number: 12\n    psf: {kind: airy, tail: 0.002}",
                  "{name: a, center_um: 0.45, fwhm_um: 0.02, shape: rectangular}, {name: b, center_um: 0.75, fwhm_um: "
                  "0.02, shape: rectangular}",
                  {[](double f) { return airy_mtf(f, 0.45, 12); }, [](double f) { return airy_mtf(f, 0.75, 12); }},
                  1024};
  EXPECT_LT(worst_error(kit, pair), 0.01);
  // Negative control: with the patterns exchanged the measurement disagrees.
  Case exchanged = pair;
  std::swap(exchanged.mtf[0], exchanged.mtf[1]);
  exchanged.paths = 32;
  EXPECT_GT(worst_error(kit, exchanged), 0.05);
}

TEST(Mtf, OfAnObscuredAperture) {
  // The autocorrelation of the annulus, by counting points of one copy that lie in the other.
  PlatformKit kit;
  auto annular = [](double f) {
    const double shift = 2 * f / kPitch * 0.6e-6 * 12, e = 0.5;  // in radii of the aperture
    double both = 0, one = 0;
    constexpr int n = 600;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double x = 2 * (i + 0.5) / n - 1, y = 2 * (j + 0.5) / n - 1, r = std::hypot(x, y),
                     s = std::hypot(x - shift, y);
        if (r > 1 || r < e) continue;
        ++one;
        both += s <= 1 && s >= e;
      }
    return both / one;
  };
  EXPECT_LT(worst_error(kit, {"obscured",
                              "f_number: 12\n    obscuration: 0.5\n    psf: {kind: airy, tail: 0.003}",
                              kNarrow,
                              {annular},
                              256}),
            0.01);
}

TEST(Mtf, OfAPicture) {
  // A box of 3 x 3 cells of 4 um: a sinc; given as a picture of 5 x 5 so that its middle counts.
  PlatformKit kit;
  GreyImage box{5, 5, std::vector<float>(25, 0)};
  for (int r = 1; r < 4; ++r)
    for (int c = 1; c < 4; ++c) box.values[static_cast<size_t>(5 * r + c)] = 2;
  kit.images["box.tif"] = box;
  auto sinc = [](double f) {
    const double n = std::sqrt(1 + kSlope * kSlope), x = 1.2 * f / n, y = x * kSlope;
    return std::fabs(std::sin(kPi * x) / (kPi * x) * std::sin(kPi * y) / (kPi * y));
  };
  EXPECT_LT(worst_error(kit, {"picture", "psf: {kind: image, file: box.tif, pixel_um: 4}", kNarrow, {sinc}}), 0.01);
}

TEST(Mtf, OfATable) {
  PlatformKit kit;
  auto gauss = [](double f) { return std::exp(-2 * kPi * kPi * 0.5 * 0.5 * f * f); };
  std::string f = "psf: {kind: mtf, cycles_per_mm: [", v = "value: [";
  for (int i = 0; i <= 80; ++i) {
    f += strf("%s%g", i ? ", " : "", 1.5 * i);  // to 120 cycles/mm = 1.2 cycles a pixel
    v += strf("%s%.8f", i ? ", " : "", gauss(0.015 * i));
  }
  EXPECT_LT(worst_error(kit, {"table", f + "], " + v + "]}", kNarrow, {gauss}, 256}), 0.01);
}

}  // namespace
}  // namespace suite::mtf_test
