// Equal parts of a few random numbers.
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <span>

namespace suite {

// Into stratum `number` of `count` (a power of two, else along the first dimension alone), by halves of the named
// dimensions in turn.
inline void put_in_stratum(std::array<double, 4>& u, std::span<const uint8_t> dimensions, uint32_t number,
                           uint32_t count) {
  if (!std::has_single_bit(count)) {
    double& first = u[dimensions[0]];
    first = (number + first) / count;
    return;
  }
  for (size_t k = 0; (1u << k) < count; ++k) {
    double& x = u[dimensions[k % dimensions.size()]];
    x = ((number >> k & 1) + x) / 2;
  }
}

}  // namespace suite
