// The planes of a leaf, value + slope . place, of eight channels at once. Internal to libs/sqt.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "sqt/vectors.h"

namespace suite::sqt {

inline constexpr size_t kTogether = 8;  // channels

// Blended over rows, one a view: {value, slope x, slope y, mass} of each channel, side by side, readable for kTogether
// of them. weight: of each row. dx, dy: the place. To the bits of one channel after the other.
inline EightFloats planes(std::span<const int16_t* const> rows, const double* weight, float dx, float dy) {
  EightFloats part[kTogether / 2] = {};  // two channels each
  for (size_t b = 0; b < rows.size(); ++b)
    for (size_t i = 0; i < kTogether / 2; ++i)
      part[i] += static_cast<float>(weight[b]) * __builtin_convertvector(load<Short8>(rows[b] + 8 * i), EightFloats);
  const EightFloats place{1, dx, dy, 0, 1, dx, dy, 0};
  for (EightFloats& p : part) p *= place;
  // Sums of neighbours; twice of that are sums of a channel's four.
  const auto pairs = [](EightFloats x, EightFloats y) {
    return __builtin_shuffle(x, y, Int8{0, 2, 8, 10, 4, 6, 12, 14}) +
           __builtin_shuffle(x, y, Int8{1, 3, 9, 11, 5, 7, 13, 15});
  };
  return __builtin_shuffle(pairs(pairs(part[0], part[1]), pairs(part[2], part[3])), Int8{0, 4, 1, 5, 2, 6, 3, 7});
}

}  // namespace suite::sqt
