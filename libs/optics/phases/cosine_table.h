// A density over the cosine of the scattering angle, linear between the entries of a table, so that sampling it is
// exact.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "math/vec.h"

namespace suite {

class CosineTable {
 public:
  // cosine: ascending from -1 to 1, at least two; value: >= 0, any scale; it is normalised to 1 over the sphere.
  // valid() is false when the integral is 0 or not finite.
  CosineTable(std::vector<double> cosine, std::vector<double> value)
      : cosine_(std::move(cosine)), value_(std::move(value)), cumulative_(cosine_.size(), 0) {
    double moment = 0;
    for (size_t i = 1; i < cosine_.size(); ++i) {
      const double a = cosine_[i - 1], b = cosine_[i], fa = value_[i - 1], fb = value_[i];
      cumulative_[i] = cumulative_[i - 1] + kPi * (fa + fb) * (b - a);
      moment += 2 * kPi * (b - a) * (fa * (2 * a + b) + fb * (a + 2 * b)) / 6;
    }
    const double whole = cumulative_.back();
    if (!(whole > 0) || !std::isfinite(whole)) return;
    valid_ = true;
    for (double& f : value_) f /= whole;
    for (double& c : cumulative_) c /= whole;
    asymmetry_ = moment / whole;
  }
  bool valid() const { return valid_; }
  double asymmetry() const { return asymmetry_; }               // mean cosine
  const std::vector<double>& values() const { return value_; }  // at the table's cosines, normalised, 1/sr
  // 1/sr.
  double at(double c) const {
    const size_t above = static_cast<size_t>(std::upper_bound(cosine_.begin(), cosine_.end(), c) - cosine_.begin());
    const size_t i = std::clamp<size_t>(above, 1, cosine_.size() - 1);
    const double t = std::clamp((c - cosine_[i - 1]) / (cosine_[i] - cosine_[i - 1]), 0.0, 1.0);
    return value_[i - 1] + (value_[i] - value_[i - 1]) * t;
  }
  // Cosine with density 2 pi at(c); u in [0, 1).
  double sample(double u) const {
    const size_t above =
        static_cast<size_t>(std::upper_bound(cumulative_.begin(), cumulative_.end(), u) - cumulative_.begin());
    const size_t i = std::clamp<size_t>(above, 1, cosine_.size() - 1);
    // Solve 2 pi (fa x + (fb - fa) x^2 / (2 w)) = rest for x in [0, w], without cancellation.
    const double w = cosine_[i] - cosine_[i - 1], fa = value_[i - 1], slope = (value_[i] - fa) / w,
                 rest = (u - cumulative_[i - 1]) / (2 * kPi);
    const double root = fa + std::sqrt(std::max(0.0, fa * fa + 2 * slope * rest));
    return std::clamp(cosine_[i - 1] + (root > 0 ? 2 * rest / root : 0), cosine_[i - 1], cosine_[i]);
  }

 private:
  std::vector<double> cosine_, value_, cumulative_;
  double asymmetry_ = 0;
  bool valid_ = false;
};

}  // namespace suite
