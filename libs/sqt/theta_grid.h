// Ascending polar angles of slices and where a direction lies between them.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/error.h"
#include "math/vec.h"

namespace suite::sqt {

// acos with an absolute error below 2e-8 over [-1, 1]; monotone. Used as the coordinate between slices, where speed
// counts and any smooth monotone function would do. Based on: Abramowitz & Stegun 4.4.46.
inline double fast_acos(double z) {
  const double a = std::min(1.0, std::fabs(z));
  const double p = 1.5707963050 +
                   a * (-0.2145988016 +
                        a * (0.0889789874 +
                             a * (-0.0501743046 +
                                  a * (0.0308918810 + a * (-0.0170881256 + a * (0.0066700901 + a * -0.0012624911))))));
  const double r = std::sqrt(1 - a) * p;
  return z < 0 ? kPi - r : r;
}

class ThetaGrid {
 public:
  struct At {
    size_t low = 0;  // between nodes low and low + 1 (the same when there is one node)
    double t = 0;    // [0, 1]
  };
  ThetaGrid() = default;
  explicit ThetaGrid(std::vector<double> nodes) : nodes_(std::move(nodes)) {  // strictly ascending, at least one
    SUITE_CHECK(!nodes_.empty());
    for (size_t i = 1; i < nodes_.size(); ++i) {
      SUITE_CHECK_LT(nodes_[i - 1], nodes_[i]);
      inverse_.push_back(1 / (nodes_[i] - nodes_[i - 1]));
    }
    const double span = nodes_.back() - nodes_.front();
    scale_ = span > 0 ? kBuckets / span : 0;
    bucket_.assign(kBuckets + 1, 0);
    for (size_t b = 0; b <= kBuckets; ++b) {
      const double low = nodes_.front() + span * (static_cast<double>(b) / kBuckets);
      while (bucket_[b] + 2 < nodes_.size() && nodes_[bucket_[b] + 1] <= low) ++bucket_[b];
      if (b < kBuckets) bucket_[b + 1] = bucket_[b];
    }
  }
  size_t size() const { return nodes_.size(); }
  double operator[](size_t i) const { return nodes_[i]; }
  const std::vector<double>& nodes() const { return nodes_; }
  At locate(double theta) const {
    if (nodes_.size() == 1) return {};
    const double clamped = std::clamp(theta, nodes_.front(), nodes_.back());
    size_t i = bucket_[static_cast<size_t>((clamped - nodes_.front()) * scale_)];
    while (i + 2 < nodes_.size() && nodes_[i + 1] <= clamped) ++i;
    return {i, std::clamp((clamped - nodes_[i]) * inverse_[i], 0.0, 1.0)};
  }
  At locate(Dir d) const { return locate(fast_acos(d.z)); }

 private:
  static constexpr size_t kBuckets = 64;
  std::vector<double> nodes_, inverse_;
  std::vector<uint32_t> bucket_;
  double scale_ = 0;
};

}  // namespace suite::sqt
