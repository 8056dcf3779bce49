#include "math/falling.h"

#include <algorithm>

namespace suite {

namespace {

// Grey, as clouds often are.
bool one_value(std::span<const float> v) {
  if (v.size() < 2 || v.front() != v.back()) return false;
  unsigned all = 1;
  for (const float x : v) all &= static_cast<unsigned>(x == v.front());
  return all;
}

}  // namespace

void exp_falling(std::span<const float> depth, std::span<float> to) {
  if (one_value(depth)) {
    std::fill(to.begin(), to.end(), exp_falling(depth.front()));
    return;
  }
  for (size_t i = 0; i < to.size(); ++i) to[i] = exp_falling(depth[i]);
}

void exp_difference(double from, std::span<const float> depth, std::span<float> to) {
  for (size_t i = 0; i < to.size(); ++i) {
    const float y = static_cast<float>(from - static_cast<double>(depth[i]));
    const float high = y < 89.0f ? y : 89.0f;
    to[i] = exp_within(high > -87.33654f ? high : -87.33654f);
  }
}

}  // namespace suite
