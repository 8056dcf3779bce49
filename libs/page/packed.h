// Numbers in few bytes for pages (live_page.h), with what that loses measured.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace suite {

struct Packed {
  std::vector<uint16_t> codes;
  double first = 0, second = 0;  // as LiveKind tells
  double loss = 0;               // the largest |stored - value| / |value|; values under 2^-24 of the largest stay out
};

// IEEE 754 binary16 of value / 2^first, nearest, ties to even. first is chosen so that the largest finite magnitude is
// below 2^15; values 2^28 times smaller than the largest have a relative error of at most 2^-11. NaN stays NaN,
// infinities stay infinite.
Packed packed_half(std::span<const float> values);

// Codes below 256, for positive numbers of which the size matters (standard errors): equal steps of the logarithm
// between the smallest and the largest positive value; zero is kept, NaN and what is negative or infinite becomes NaN.
Packed packed_log8(std::span<const float> values);

// The bits of the binary16 nearest to x, ties to even; beyond 65504 infinite.
uint16_t half_bits(float x);

}  // namespace suite
