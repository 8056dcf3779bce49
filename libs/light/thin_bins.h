// Which bins are thin over a way in a layer of air, so that series do for them (air_loops.h): gases are opaque in few.
#pragma once
#include <algorithm>
#include <vector>

#include "air/column.h"
#include "light/air_loops.h"

namespace suite {

class ThinBins {
 public:
  explicit ThinBins(const AirColumn& column) : bins_(column.bins), blocks_((bins_ + kBlock - 1) / kBlock) {
    for (size_t l = 0; l < column.layers(); ++l) {
      const float* const k = &column.extinction[l * bins_];
      for (size_t i = 0; i < bins_; i += kBlock)
        greatest_.push_back(*std::max_element(k + i, k + std::min(i + kBlock, bins_)));
    }
  }
  // work(first, count, thin) for each stretch of them, in order. way: m.
  template <class Work>
  void over(size_t layer, double way, const Work& work) const {
    const auto most = static_cast<float>(kMost / way);
    const float* const greatest = &greatest_[layer * blocks_];
    for (size_t first = 0, last = 0; first < blocks_; first = last) {
      const bool thin = greatest[first] <= most;
      while (last < blocks_ && (greatest[last] <= most) == thin) ++last;
      work(first * kBlock, std::min(bins_, last * kBlock) - first * kBlock, thin);
    }
  }
  // Whether all are.
  bool all(size_t layer, double way) const {
    const float* const greatest = &greatest_[layer * blocks_];
    return *std::max_element(greatest, greatest + blocks_) * way <= kMost;
  }

 private:
  static constexpr double kMost = 0.8 * double{air_loops::kThin};
  static constexpr size_t kBlock = 8;  // of bins
  size_t bins_, blocks_;
  std::vector<float> greatest_;  // extinction, [layer][block]
};

}  // namespace suite
