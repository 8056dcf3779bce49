#include "heat/compact_rows.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"

namespace suite {

namespace {

constexpr double kMost = 65535;

}  // namespace

CompactRows::CompactRows(std::span<const float> values, size_t width)
    : CompactRows(width > 0 ? values.size() / width : 0, width) {
  SUITE_CHECK_EQ(rows() * width, values.size());
  parallel_for(0, rows(), 256, [&](size_t first, size_t last) {
    for (size_t row = first; row < last; ++row) set(row, values.subspan(row * width_, width_));
  });
}

void CompactRows::set(size_t row, std::span<const float> values) {
  SUITE_CHECK(values.size() == width_ && width_ > 0);
  float least = values[0], most = values[0];
  bool finite = true;
  for (const float v : values)
    least = std::min(least, v), most = std::max(most, v), finite = finite && std::isfinite(v);
  least_[row] = finite ? least : NAN;
  const double span = double{most} - double{least};
  step_[row] = static_cast<float>(span / kMost);
  const double per_step = finite && step_[row] > 0 ? 1 / double{step_[row]} : 0;
  uint16_t* to = &above_[row * width_];
  for (size_t k = 0; k < width_; ++k)
    to[k] = per_step > 0
                ? static_cast<uint16_t>(std::min(kMost, std::nearbyint((double{values[k]} - double{least}) * per_step)))
                : uint16_t{0};
}

void CompactRows::resize(size_t rows) { least_.resize(rows), step_.resize(rows), above_.resize(rows * width_); }

void CompactRows::get(size_t row, std::span<float> values) const {
  for (size_t k = 0; k < values.size(); ++k) values[k] = static_cast<float>(at(row, k));
}

std::vector<float> CompactRows::floats() const {
  std::vector<float> out(above_.size());
  for (size_t row = 0; row < rows(); ++row) get(row, {&out[row * width_], width_});
  return out;
}

}  // namespace suite
