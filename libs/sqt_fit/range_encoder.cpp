#include "sqt_fit/range_encoder.h"

namespace suite::sqt {

void RangeEncoder::shift() {
  // A byte leaves when no later carry can change it any more; runs of 0xFF wait.
  if (static_cast<uint32_t>(low_) < 0xFF000000u || (low_ >> 32) != 0) {
    const auto carry = static_cast<uint8_t>(low_ >> 32);
    uint8_t out = cache_;
    do {
      bytes_.push_back(static_cast<std::byte>(static_cast<uint8_t>(out + carry)));
      out = 0xFF;
    } while (--pending_ != 0);
    cache_ = static_cast<uint8_t>(low_ >> 24);
  }
  ++pending_;
  low_ = (low_ & 0x00FFFFFFu) << 8;
}

std::vector<std::byte> RangeEncoder::finish() {
  for (int i = 0; i < 5; ++i) shift();
  return std::move(bytes_);
}

}  // namespace suite::sqt
