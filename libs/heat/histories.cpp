#include "heat/histories.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"

namespace suite {

void Histories::set(size_t row, std::span<const double> values) {
  SUITE_CHECK_EQ(values.size(), moments_);
  const double least = *std::min_element(values.begin(), values.end());
  least_[row] = least;
  for (size_t m = 0; m < moments_; ++m) above_[row * moments_ + m] = static_cast<float>(values[m] - least);
}

void Histories::get(size_t row, std::span<double> values) const {
  SUITE_CHECK_EQ(values.size(), moments_);
  for (size_t m = 0; m < moments_; ++m) values[m] = at(row, m);
}

std::vector<double> Histories::values() const {
  std::vector<double> out(rows() * moments_);
  for (size_t row = 0; row < rows(); ++row) get(row, {&out[row * moments_], moments_});
  return out;
}

void Histories::change(const std::function<double(double)>& to) {
  parallel_for(0, rows(), 64, [&](size_t first, size_t last) {
    std::vector<double> values(moments_);
    for (size_t row = first; row < last; ++row) {
      get(row, values);
      for (double& v : values) v = to(v);
      set(row, values);
    }
  });
}

void Histories::take(const Histories& first) {
  SUITE_CHECK(first.moments_ == moments_ && first.rows() <= rows());
  std::copy(first.least_.begin(), first.least_.end(), least_.begin());
  std::copy(first.above_.begin(), first.above_.end(), above_.begin());
}

void Histories::shrink(size_t rows) {
  SUITE_CHECK(rows <= least_.size());
  least_.resize(rows), above_.resize(rows * moments_);
}

}  // namespace suite
