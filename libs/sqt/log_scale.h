// How whole numbers stand for log2 values in decoded trees.
#pragma once
#include <algorithm>
#include <cmath>

namespace suite::sqt {

// offset + number * 2^-fraction_bits.
struct LogScale {
  static constexpr int kMost = 16383;                   // largest number, either sign
  static constexpr int kLeastBits = 9, kMostBits = 12;  // 64 octaves in all, or finer and fewer
  static constexpr int kMostOffset = 120;               // octaves, either sign
  int offset = 0;
  int fraction_bits = kMostBits;
  float unit() const { return 1.0f / static_cast<float>(1 << fraction_bits); }
  float value(float number) const { return static_cast<float>(offset) + number * unit(); }
  // The finest scale that holds low..high (log2) with two octaves to spare, or the coarsest there is.
  static LogScale of(float low, float high) {
    LogScale s;
    s.offset = static_cast<int>(std::clamp(std::round(0.5f * (low + high)), -1.0f * kMostOffset, 1.0f * kMostOffset));
    const float half = 0.5f * (high - low) + 2.5f;
    while (s.fraction_bits > kLeastBits && half * static_cast<float>(1 << s.fraction_bits) > kMost) --s.fraction_bits;
    return s;
  }
};

}  // namespace suite::sqt
