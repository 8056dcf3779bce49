// The code of totals and scales, which encoder and decoder share: tables of logarithms, predicted and coded by a range
// coder. Internal to libs/sqt and libs/sqt_fit.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sqt/aligned.h"
#include "sqt/range_decoder.h"

namespace suite::sqt {

// A signed integer by Elias-gamma of its folded value, with learnt prefix bits.
struct IntegerModel {
  std::array<BitContext, 40> prefix;
  template <class Coder>
  int code(Coder& coder, int value) {
    const uint32_t folded = (value < 0 ? 2 * static_cast<uint32_t>(-value) - 1 : 2 * static_cast<uint32_t>(value)) + 1;
    int bits = 0;
    while (bits < 24 && coder.bit(prefix[static_cast<size_t>(bits)], (folded >> (bits + 1)) != 0)) ++bits;
    uint32_t got = 1;
    for (int b = bits - 1; b >= 0; --b) got = (got << 1) | (coder.even_bit((folded >> b) & 1) ? 1u : 0u);
    got -= 1;
    return got & 1 ? -static_cast<int>((got + 1) / 2) : static_cast<int>(got / 2);
  }
};

inline constexpr double kTotalSteps = 2048;  // per factor of two

// A table [row][column] of log2 values, each predicted by the plane through its three predecessors.
template <class Coder>
void code_table(Coder& coder, std::vector<float>& log2_values, size_t columns) {
  IntegerModel model;
  std::vector<int> done(log2_values.size());
  for (size_t i = 0; i < log2_values.size(); ++i) {
    const bool left = i % columns > 0, up = i >= columns;
    const int predicted = left && up ? done[i - 1] + done[i - columns] - done[i - columns - 1]
                          : left     ? done[i - 1]
                          : up       ? done[i - columns]
                                     : 0;
    int value = 0;
    if constexpr (Coder::kEncodes)
      value =
          static_cast<int>(std::lround(std::clamp(static_cast<double>(log2_values[i]), -200.0, 100.0) * kTotalSteps));
    done[i] = std::clamp(predicted + model.code(coder, value - predicted), -1000000, 1000000);
    log2_values[i] = static_cast<float>(done[i] / kTotalSteps);
  }
}

inline constexpr float kNoTotal = -40;  // log2 that stands for nothing at all

template <class Coder>
void code_totals(Coder& coder, AlignedTotals& totals, size_t channels) {
  const size_t m = totals.magnitude_um.size();
  auto code_linear = [&](std::vector<float>& values, size_t columns) {
    if constexpr (Coder::kEncodes)
      for (float& v : values) v = v > 0 ? std::max(kNoTotal, std::log2(v)) : kNoTotal;
    code_table(coder, values, columns);
    for (float& v : values) v = v <= kNoTotal ? 0.0f : std::exp2(std::min(v, 20.0f));
  };
  code_linear(totals.magnitudes, m);
  code_table(coder, totals.log2_scale, channels);
  if (!totals.delta.empty()) code_linear(totals.delta, channels);
}

}  // namespace suite::sqt
