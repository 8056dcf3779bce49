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
  const double a = std::min(1.0, std::fabs(z)), a2 = a * a, a4 = a2 * a2;
  const double p = ((1.5707963050 - 0.2145988016 * a) + a2 * (0.0889789874 - 0.0501743046 * a)) +
                   a4 * ((0.0308918810 - 0.0170881256 * a) + a2 * (0.0066700901 - 0.0012624911 * a));
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
    double least = kPi;
    for (size_t i = 1; i < nodes_.size(); ++i) {
      SUITE_CHECK_LT(nodes_[i - 1], nodes_[i]);
      least = std::min(least, nodes_[i] - nodes_[i - 1]);
      intervals_.push_back(
          {nodes_[i - 1], 1 / (nodes_[i] - nodes_[i - 1]), i + 1 < nodes_.size() ? nodes_[i] : kNever});
    }
    if (intervals_.empty()) intervals_.push_back({nodes_[0], 0, kNever});
    // Buckets narrower than the narrowest interval: the node sought is the bucket's first or the next.
    const double span = nodes_.back() - nodes_.front();
    const size_t buckets = static_cast<size_t>(std::clamp(std::ceil(span / least) + 1, 1.0, 4096.0));
    scale_ = span > 0 ? static_cast<double>(buckets) / span : 0;
    bucket_.assign(buckets + 1, 0);
    for (size_t b = 0; b <= buckets; ++b) {
      const double low = nodes_.front() + span * (static_cast<double>(b) / static_cast<double>(buckets));
      while (intervals_[bucket_[b]].end <= low) ++bucket_[b];
      if (b < buckets) bucket_[b + 1] = bucket_[b];
    }
  }
  size_t size() const { return nodes_.size(); }
  double operator[](size_t i) const { return nodes_[i]; }
  const std::vector<double>& nodes() const { return nodes_; }
  At locate(double theta) const {
    const double clamped = std::clamp(theta, nodes_.front(), nodes_.back());
    size_t i = bucket_[static_cast<size_t>((clamped - nodes_.front()) * scale_)];
    i += clamped >= intervals_[i].end;
    while (clamped >= intervals_[i].end) ++i;  // only where buckets are wider than intervals
    return {i, std::min(1.0, (clamped - intervals_[i].begin) * intervals_[i].inverse)};
  }
  At locate(Dir d) const { return locate(fast_acos(d.z)); }

 private:
  static constexpr double kNever = 1e9;
  struct Interval {
    double begin, inverse, end;  // inverse width; the last interval never ends
  };
  std::vector<double> nodes_;
  std::vector<Interval> intervals_;
  std::vector<uint32_t> bucket_;
  double scale_ = 0;
};

}  // namespace suite::sqt
