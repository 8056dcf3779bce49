#include "spectral/blackbody_table.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

namespace {
constexpr double kBlackbodyTableStep = 1.0 / 32;  // of ln T
constexpr double kFloor = -100;                   // ln of what counts as nothing; its exponential is still a float
}  // namespace

BlackbodyTable::BlackbodyTable(std::span<const Bin> bins, double low_k, double high_k)
    : bins_(bins.size()), low_(low_k), high_(high_k), first_(std::log(low_k) - kBlackbodyTableStep) {
  SUITE_CHECK(low_k > 0 && low_k <= high_k);
  // One row before and two behind, so that every cubic has its four points.
  const auto rows = static_cast<size_t>(std::ceil((std::log(high_k) - std::log(low_k)) / kBlackbodyTableStep)) + 4;
  logarithm_.reserve(rows * bins_);
  for (size_t r = 0; r < rows; ++r) {
    const double kelvin = std::exp(first_ + static_cast<double>(r) * kBlackbodyTableStep);
    for (const Bin& b : bins) {
      const double mean = planck_band_radiance(b.low_um, b.high_um, kelvin) / (b.high_um - b.low_um);
      logarithm_.push_back(static_cast<float>(mean > 0 ? std::max(kFloor, std::log(mean)) : kFloor));
    }
  }
}

void BlackbodyTable::radiance(double kelvin, std::span<float> out) const {
  const double x = (std::log(std::clamp(kelvin, low_, high_)) - first_) / kBlackbodyTableStep;
  const auto row = static_cast<size_t>(x);
  const double t = x - static_cast<double>(row);
  // Lagrange weights of the rows at -1, 0, 1, 2.
  const double w[4] = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
                       (t + 1) * t * (t - 1) / 6};
  const float* a = &logarithm_[(row - 1) * bins_];
  for (size_t i = 0; i < bins_; ++i)
    out[i] = static_cast<float>(
        std::exp(w[0] * a[i] + w[1] * a[bins_ + i] + w[2] * a[2 * bins_ + i] + w[3] * a[3 * bins_ + i]));
}

}  // namespace suite
