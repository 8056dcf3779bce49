// Means of what is given by moment over the parts of a span, for errors.
#pragma once
#include <algorithm>
#include <vector>

#include "base/error.h"
#include "heat/heat_balance.h"

namespace suite {

class PartMeans {
 public:
  explicit PartMeans(size_t moments) : moments_(moments) { SUITE_CHECK(moments >= kHeatParts); }
  size_t part(size_t moment) const { return std::min(kHeatParts - size_t{1}, moment * kHeatParts / moments_); }
  template <class Value>
  std::vector<double> means(const Value& value) const {
    std::vector<double> sum(kHeatParts, 0), count(kHeatParts, 0);
    for (size_t k = 0; k < moments_; ++k) sum[part(k)] += value(k), count[part(k)] += 1;
    for (size_t p = 0; p < kHeatParts; ++p) sum[p] /= count[p];
    return sum;
  }

 private:
  size_t moments_;
};

}  // namespace suite
