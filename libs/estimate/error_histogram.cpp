#include "estimate/error_histogram.h"

#include <algorithm>
#include <cmath>

namespace suite {

void ErrorHistogram::add(double relative_error) {
  const double bin = 64 * std::log2(std::max(relative_error, 1e-9) / 1e-9);
  ++counts_[bin < kBins - 1 ? static_cast<size_t>(bin) : kBins - 1];  // unknown ones (infinite, NaN) are the largest
  ++total_;
}

void ErrorHistogram::merge(const ErrorHistogram& o) {
  for (size_t i = 0; i < kBins; ++i) counts_[i] += o.counts_[i];
  total_ += o.total_;
}

double ErrorHistogram::median() const {
  uint64_t seen = 0;
  for (size_t i = 0; i < kBins; ++i)
    if ((seen += counts_[i]) * 2 >= total_ && total_)
      return i == 0 ? 0 : i == kBins - 1 ? INFINITY : 1e-9 * std::exp2((static_cast<double>(i) + 0.5) / 64);
  return 0;
}

}  // namespace suite
