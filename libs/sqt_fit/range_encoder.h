// The writing side of the adaptive binary range coder; see sqt/range_decoder.h.
#pragma once
#include <vector>

#include "sqt/range_decoder.h"

namespace suite::sqt {

class RangeEncoder {
 public:
  static constexpr bool kEncodes = true;
  // Codes `bit` and returns it.
  bool bit(BitContext& context, bool bit) {
    const uint32_t bound = (range_ >> 12) * context.bounded();
    if (bit) {
      low_ += bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    context.update(bit);
    normalise();
    return bit;
  }
  bool even_bit(bool bit) {  // probability 1/2, nothing learnt
    range_ >>= 1;
    if (bit) low_ += range_;
    normalise();
    return bit;
  }
  std::vector<std::byte> finish();
  size_t size() const { return bytes_.size() + pending_; }

 private:
  void normalise() {
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      shift();
    }
  }
  void shift();
  uint64_t low_ = 0;
  uint32_t range_ = 0xFFFFFFFFu;
  uint8_t cache_ = 0;
  size_t pending_ = 1;
  std::vector<std::byte> bytes_;
};

}  // namespace suite::sqt
