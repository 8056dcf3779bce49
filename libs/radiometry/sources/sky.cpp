#include <algorithm>
#include <cmath>

#include "radiometry/sources/source.h"

namespace suite {

Sky::Sky(const SkySpec& spec, const SpectralState& state)
    : spectrum_(state.sample(spec.radiance)), table_(spec.table), theta_max_(spec.full_sphere ? kPi : kPi / 2), full_sphere_(spec.full_sphere) {
  if (spec.radiance.min() < 0) throw Error("the sky's radiance is negative");
  if (table_.empty()) return;
  if (spec.zeniths < 2 || spec.azimuths < 1 || table_.size() != spec.zeniths * spec.azimuths)
    throw Error(strf("a sky table of %zu values is not %zu zeniths by %zu azimuths", table_.size(), spec.zeniths, spec.azimuths));
  for (const double v : table_)
    if (!(v >= 0) || !std::isfinite(v)) throw Error("a sky table holds a negative or infinite value");
  rows_ = spec.zeniths - 1;
  columns_ = spec.azimuths;
  double sum = 0;
  for (size_t r = 0; r < rows_; ++r)
    for (size_t c = 0; c < columns_; ++c) {
      const size_t n = (c + 1) % columns_;
      const double mean = 0.25 * (table_[r * columns_ + c] + table_[r * columns_ + n] + table_[(r + 1) * columns_ + c] + table_[(r + 1) * columns_ + n]);
      cdf_.push_back(sum += mean * cell_solid_angle(r));
    }
  if (!(sum > 0)) {  // black: nothing to draw
    table_.clear();
    cdf_.clear();
    std::fill(spectrum_.begin(), spectrum_.end(), 0.0f);
    return;
  }
  for (double& v : cdf_) v /= sum;
  cdf_.back() = 1;
}

double Sky::cell_solid_angle(size_t row) const {
  const double a = theta_max_ * static_cast<double>(row) / static_cast<double>(rows_), b = theta_max_ * static_cast<double>(row + 1) / static_cast<double>(rows_);
  return (std::cos(a) - std::cos(b)) * 2 * kPi / static_cast<double>(columns_);
}

double Sky::relative(Dir d) const {
  if (d.z < 0 && !full_sphere_) return 0;
  if (table_.empty()) return 1;
  // Bilinear between the table's directions.
  const double row = std::clamp(polar_angle(d) / theta_max_, 0.0, 1.0) * static_cast<double>(rows_);
  double phi = azimuth(d) / (2 * kPi);
  phi -= std::floor(phi);
  const double column = phi * static_cast<double>(columns_);
  const size_t r = std::min(rows_ - 1, static_cast<size_t>(row)), c = std::min(columns_ - 1, static_cast<size_t>(column)), n = (c + 1) % columns_;
  const double fr = row - static_cast<double>(r), fc = column - static_cast<double>(c);
  return (1 - fr) * ((1 - fc) * table_[r * columns_ + c] + fc * table_[r * columns_ + n]) +
         fr * ((1 - fc) * table_[(r + 1) * columns_ + c] + fc * table_[(r + 1) * columns_ + n]);
}

size_t Sky::cell_of(Dir d, size_t& row) const {
  row = std::min(rows_ - 1, static_cast<size_t>(std::clamp(polar_angle(d) / theta_max_, 0.0, 1.0) * static_cast<double>(rows_)));
  double phi = azimuth(d) / (2 * kPi);
  phi -= std::floor(phi);
  return row * columns_ + std::min(columns_ - 1, static_cast<size_t>(phi * static_cast<double>(columns_)));
}

double Sky::density(Dir d) const {
  if (d.z < 0 && !full_sphere_) return 0;
  size_t row = 0;
  const size_t cell = cell_of(d, row);
  return (cdf_[cell] - (cell ? cdf_[cell - 1] : 0.0)) / cell_solid_angle(row);
}

DirectionSample Sky::sample(Vec2 u) const {
  const size_t cell = std::min(cdf_.size() - 1, static_cast<size_t>(std::upper_bound(cdf_.begin(), cdf_.end(), u.x) - cdf_.begin()));
  const double before = cell ? cdf_[cell - 1] : 0, probability = cdf_[cell] - before;
  const size_t row = cell / columns_;
  // Uniform in solid angle inside the cell; what is left of u.x after choosing the cell is uniform again.
  const double x = std::clamp((u.x - before) / probability, 0.0, 1.0);
  const double a = std::cos(theta_max_ * static_cast<double>(row) / static_cast<double>(rows_)), b = std::cos(theta_max_ * static_cast<double>(row + 1) / static_cast<double>(rows_));
  const double z = a + (b - a) * x, phi = 2 * kPi * (static_cast<double>(cell % columns_) + u.y) / static_cast<double>(columns_);
  const double s = std::sqrt(std::max(0.0, 1 - z * z));
  return {{s * std::cos(phi), s * std::sin(phi), z}, probability / cell_solid_angle(row)};
}

}  // namespace suite
