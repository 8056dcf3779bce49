// Texture maps: whatever the image, the chosen curves have the family's mean and band-to-band covariance. The control
// picks the nearest curve by value instead, which does not.
#include <gtest/gtest.h>

#include <cmath>

#include "math/sampling.h"
#include "scene/texture.h"

namespace suite::texture_test {
namespace {

constexpr size_t kBands = 6;

std::vector<Curve> family(Pcg32& random) {
  std::vector<Curve> out;
  for (int k = 0; k < 30; ++k) {
    const double level = random.uniform(), tilt = random.uniform() - 0.5;
    std::vector<double> x, y;
    for (size_t b = 0; b < kBands; ++b)
      x.push_back(0.4 + 0.1 * static_cast<double>(b)),
          y.push_back(0.3 + 0.2 * level + 0.1 * tilt * static_cast<double>(b) / kBands + 0.01 * random.uniform());
    out.push_back(Curve(x, y, Outside::hold));
  }
  return out;
}

struct Moments {
  std::vector<double> mean = std::vector<double>(kBands), covariance = std::vector<double>(kBands * kBands);
};
Moments moments(const std::vector<Curve>& curves, const std::vector<uint16_t>& chosen) {
  Moments m;
  const auto value = [&](uint16_t c, size_t b) { return curves[c].at(0.4 + 0.1 * static_cast<double>(b)); };
  for (const uint16_t c : chosen)
    for (size_t b = 0; b < kBands; ++b) m.mean[b] += value(c, b) / static_cast<double>(chosen.size());
  for (const uint16_t c : chosen)
    for (size_t a = 0; a < kBands; ++a)
      for (size_t b = 0; b < kBands; ++b)
        m.covariance[a * kBands + b] +=
            (value(c, a) - m.mean[a]) * (value(c, b) - m.mean[b]) / static_cast<double>(chosen.size());
  return m;
}
double worst(const std::vector<double>& got, const std::vector<double>& wanted) {
  double scale = 0, error = 0;
  for (const double w : wanted) scale = std::fmax(scale, std::fabs(w));
  for (size_t i = 0; i < got.size(); ++i) error = std::fmax(error, std::fabs(got[i] - wanted[i]) / scale);
  return error;
}

TEST(Texture, MeanAndCovarianceOfTheFamilyAreKept) {
  Pcg32 random(11);
  const std::vector<Curve> curves = family(random);
  std::vector<uint16_t> once(curves.size());
  for (size_t k = 0; k < once.size(); ++k) once[k] = static_cast<uint16_t>(k);
  const Moments wanted = moments(curves, once);
  // A skewed image with many equal values: what a photograph of grass looks like.
  std::vector<float> image(64 * 64);
  for (float& v : image) v = static_cast<float>(std::floor(255 * std::pow(random.uniform(), 3)));
  const std::array<double, 2> band{0.45, 0.75};
  const std::vector<uint16_t> chosen = choose_curves(image, 1, curves, std::span(&band, 1));
  const Moments got = moments(curves, chosen);
  EXPECT_LT(worst(got.mean, wanted.mean), 0.05);
  EXPECT_LT(worst(got.covariance, wanted.covariance), 0.05);
  // Brighter pixels never get darker curves.
  for (size_t i = 1; i < image.size(); ++i)
    if (image[i] > image[0]) {
      EXPECT_GE(curves[chosen[i]].mean(0.45, 0.75), curves[chosen[0]].mean(0.45, 0.75));
    }

  std::vector<uint16_t> nearest;
  for (const float v : image) {
    size_t best = 0;
    const auto distance = [&](size_t k) { return std::fabs(curves[k].mean(0.45, 0.75) - (0.3 + 0.2 * v / 255)); };
    for (size_t k = 1; k < curves.size(); ++k)
      if (distance(k) < distance(best)) best = k;
    nearest.push_back(static_cast<uint16_t>(best));
  }
  EXPECT_GT(worst(moments(curves, nearest).covariance, wanted.covariance), 0.05);
}

TEST(Texture, FaultsAreTold) {
  const std::array<double, 2> band{0.3, 0.5};
  const std::vector<Curve> short_one{Curve({0.4, 0.5}, {0.1, 0.2}, Outside::error)};
  const float pixel = 1;
  EXPECT_THROW(choose_curves(std::span(&pixel, 1), 1, short_one, std::span(&band, 1)), Error);
  EXPECT_THROW(choose_curves(std::span(&pixel, 1), 1, {}, std::span(&band, 1)), Error);
}

}  // namespace
}  // namespace suite::texture_test
