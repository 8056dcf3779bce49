#include "scene/texture.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace suite {

namespace {

// Columns to mean 0 and deviation 1; a constant column becomes 0.
void standardise(std::vector<double>& rows, size_t bands) {
  const size_t n = rows.size() / bands;
  for (size_t b = 0; b < bands; ++b) {
    double mean = 0, square = 0;
    for (size_t i = 0; i < n; ++i) mean += rows[i * bands + b] / static_cast<double>(n);
    for (size_t i = 0; i < n; ++i) square += std::pow(rows[i * bands + b] - mean, 2) / static_cast<double>(n);
    const double deviation = std::sqrt(square);
    for (size_t i = 0; i < n; ++i)
      rows[i * bands + b] = deviation > 1e-12 * (1 + std::fabs(mean)) ? (rows[i * bands + b] - mean) / deviation : 0;
  }
}

// The direction of largest variance of standardised rows, by power iteration; its largest part is positive.
std::vector<double> main_direction(const std::vector<double>& rows, size_t bands) {
  std::vector<double> v(bands, 1 / std::sqrt(static_cast<double>(bands)));
  for (int turn = 0; turn < 200; ++turn) {
    std::vector<double> next(bands, 0.0);
    for (size_t i = 0; i < rows.size(); i += bands) {
      double along = 0;
      for (size_t b = 0; b < bands; ++b) along += rows[i + b] * v[b];
      for (size_t b = 0; b < bands; ++b) next[b] += along * rows[i + b];
    }
    double norm = 0;
    for (const double x : next) norm += x * x;
    if (!(norm > 0)) break;
    for (size_t b = 0; b < bands; ++b) v[b] = next[b] / std::sqrt(norm);
  }
  const auto largest =
      std::max_element(v.begin(), v.end(), [](double a, double b) { return std::fabs(a) < std::fabs(b); });
  if (*largest < 0)
    for (double& x : v) x = -x;
  return v;
}

std::vector<double> along(const std::vector<double>& rows, const std::vector<double>& v) {
  std::vector<double> out(rows.size() / v.size(), 0.0);
  for (size_t i = 0; i < out.size(); ++i)
    for (size_t b = 0; b < v.size(); ++b) out[i] += rows[i * v.size() + b] * v[b];
  return out;
}

// Equal pixels in an order that has no direction: neighbours in the file must not become neighbours in rank.
uint64_t hashed(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

}  // namespace

std::vector<uint16_t> choose_curves(std::span<const float> image, size_t bands, std::span<const Curve> family,
                                    std::span<const std::array<double, 2>> bands_um) {
  SUITE_CHECK_EQ(bands, bands_um.size());
  if (family.empty() || family.size() > 65535)
    throw Error(strf("a family of %zu curves", family.size()), "1 to 65535 are expected");
  std::vector<double> curves;
  for (const Curve& c : family)
    for (const auto& band : bands_um) curves.push_back(c.mean(band[0], band[1]));
  std::vector<double> pixels(image.begin(), image.end());
  standardise(curves, bands);
  standardise(pixels, bands);
  const std::vector<double> direction = main_direction(curves, bands);
  const std::vector<double> curve_at = along(curves, direction), pixel_at = along(pixels, direction);
  std::vector<uint32_t> curve_order(family.size()), pixel_order(pixel_at.size());
  std::iota(curve_order.begin(), curve_order.end(), 0u);
  std::iota(pixel_order.begin(), pixel_order.end(), 0u);
  std::stable_sort(curve_order.begin(), curve_order.end(),
                   [&](uint32_t a, uint32_t b) { return curve_at[a] < curve_at[b]; });
  std::sort(pixel_order.begin(), pixel_order.end(), [&](uint32_t a, uint32_t b) {
    return pixel_at[a] != pixel_at[b] ? pixel_at[a] < pixel_at[b] : hashed(a) < hashed(b);
  });
  std::vector<uint16_t> chosen(pixel_order.size());
  for (size_t rank = 0; rank < pixel_order.size(); ++rank)
    chosen[pixel_order[rank]] = static_cast<uint16_t>(curve_order[rank * family.size() / pixel_order.size()]);
  return chosen;
}

}  // namespace suite
