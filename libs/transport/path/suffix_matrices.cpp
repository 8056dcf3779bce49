#include "transport/path/suffix_matrices.h"

#include <algorithm>

namespace suite {

void SuffixMatrices::begin(const SuffixMatrices& as) {
  product_.resize(as.product_.size());
  std::copy_n(as.product_.begin(), as.size_, product_.begin());
  size_ = as.size_, event_.unknown = as.event_.unknown;
}

void SuffixMatrices::take(ScatterModel::Polarised next) {
  const size_t bins = next_.size(), size = next.grey ? 1 : bins;
  const auto unknown = static_cast<float>(next.unknown);
  if (size_ == 0) {
    product_.swap(next_);
    size_ = size, event_.unknown = unknown;
    return;
  }
  event_.unknown = 1 - (1 - event_.unknown) * (1 - unknown);
  if (size_ < size) {
    std::fill(product_.begin() + 1, product_.end(), product_[0]);
    size_ = size;
  }
  for (size_t b = 0; b < size_; ++b) product_[b] = product_[b] * next_[size == 1 ? 0 : b];
}

}  // namespace suite
