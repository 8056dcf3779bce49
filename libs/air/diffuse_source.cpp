#include "air/diffuse_source.h"

#include <algorithm>
#include <cmath>

namespace suite {

DiffuseSource::DiffuseSource(size_t layers, size_t bins, Axes axes)
    : axes_(std::move(axes)), layers_(layers), bins_(bins) {
  table_.resize(layers * 2 * directions() * bins);
}

double DiffuseSource::azimuth(size_t index) const {
  if (axes_.azimuths == 1) return axes_.symmetric.value_or(0);
  const auto n = static_cast<double>(axes_.symmetric ? 2 * (axes_.azimuths - 1) : axes_.azimuths);
  return axes_.symmetric.value_or(0) + static_cast<double>(index) * 2 * kPi / n;
}

DiffuseSource::Corners DiffuseSource::corners(double cosine, double azimuth) const {
  const std::vector<double>& x = axes_.cosines;
  const auto above = static_cast<size_t>(std::upper_bound(x.begin(), x.end(), cosine) - x.begin());
  const size_t low = std::clamp<size_t>(above, 1, x.size() - 1) - 1;
  const auto v = static_cast<float>(std::clamp((cosine - x[low]) / (x[low + 1] - x[low]), 0.0, 1.0));
  size_t a = 0, b = 0;
  float u = 0;
  if (const size_t n = axes_.azimuths; n > 1) {
    double turn = azimuth - axes_.symmetric.value_or(0);
    turn -= 2 * kPi * std::floor(turn / (2 * kPi));
    if (axes_.symmetric && turn > kPi) turn = 2 * kPi - turn;
    const double place = turn / (2 * kPi) * static_cast<double>(axes_.symmetric ? 2 * (n - 1) : n);
    a = std::min(static_cast<size_t>(place), n - 1);
    b = axes_.symmetric ? std::min(a + 1, n - 1) : (a + 1) % n;
    u = static_cast<float>(place - static_cast<double>(a));
  }
  return {{direction(low, a), direction(low, b), direction(low + 1, a), direction(low + 1, b)},
          {(1 - v) * (1 - u), (1 - v) * u, v * (1 - u), v * u}};
}

void DiffuseSource::set_suns(std::vector<double> zenith, double at_origin) {
  suns_ = {std::move(zenith), at_origin, {}};
  suns_.factor.assign(suns_.zenith.size() * layers_ * bins_, 1.0f);
}

void DiffuseSource::relight(size_t layer, double cosine, float* near, float* far) const {
  constexpr double kSame = 1e-3;
  if (std::fabs(cosine - suns_.at_origin) < kSame) return;
  const std::vector<double>& x = suns_.zenith;
  const double zenith = std::acos(std::clamp(cosine, -1.0, 1.0));
  const auto above = static_cast<size_t>(std::upper_bound(x.begin(), x.end(), zenith) - x.begin());
  const size_t low = std::clamp<size_t>(above, 1, x.size() - 1) - 1;
  const auto share = static_cast<float>(std::clamp((zenith - x[low]) / (x[low + 1] - x[low]), 0.0, 1.0));
  const float *first = &suns_.factor[(low * layers_ + layer) * bins_], *second = first + layers_ * bins_;
  for (size_t i = 0; i < bins_; ++i) {
    const float factor = first[i] + share * (second[i] - first[i]);
    near[i] *= factor, far[i] *= factor;
  }
}

}  // namespace suite
