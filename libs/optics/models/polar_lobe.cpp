#include "optics/models/polar_lobe.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {
constexpr size_t kCells = 256;
// Cells are even in the cube root of the cosine.
double edge(size_t cell) {
  const double y = static_cast<double>(cell) / kCells;
  return y * y * y;
}
double width(size_t cell) { return edge(cell + 1) * edge(cell + 1) - edge(cell) * edge(cell); }  // of mu^2
}  // namespace

PolarLobe::PolarLobe(const std::function<double(double)>& weight) : below_(kCells + 1), density_(kCells) {
  double sum = 0;
  for (size_t c = 0; c < kCells; ++c) sum += (density_[c] = weight(0.5 * (edge(c) + edge(c + 1)))) * width(c);
  for (size_t c = 0; c < kCells; ++c) {
    // A thousandth goes everywhere: no direction of the weight is out of reach.
    density_[c] = sum > 0 ? 0.999 * density_[c] / sum + 0.001 : 1;
    below_[c + 1] = below_[c] + density_[c] * width(c);
  }
  for (double& b : below_) b /= below_[kCells];
  for (double& d : density_) d /= kPi;
}

Dir PolarLobe::sample(Vec2 u) const {
  const auto above = std::upper_bound(below_.begin() + 1, below_.end() - 1, u.x);
  const size_t c = static_cast<size_t>(above - below_.begin()) - 1;
  const double within = (u.x - below_[c]) / (below_[c + 1] - below_[c]), low = edge(c) * edge(c);
  const double mu2 = std::clamp(low + within * width(c), 0.0, 1.0), s = std::sqrt(1 - mu2), phi = 2 * kPi * u.y;
  return {s * std::cos(phi), s * std::sin(phi), std::sqrt(mu2)};
}

double PolarLobe::pdf(double mu) const {
  return density_[std::min(kCells - 1, static_cast<size_t>(std::cbrt(mu) * kCells))] * mu;
}

}  // namespace suite
