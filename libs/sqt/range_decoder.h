// An adaptive binary range coder: bits whose probabilities are learnt, per context, while coding.
//
// Based on: G. N. N. Martin, "Range encoding", 1979, in the carry-propagating binary form of I. Pavlov's LZMA; the two
// adaptation rates per context are averaged (as in VP9 successors and HEVC's proposals).
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace suite::sqt {

// Probability of a 0 bit in 1/65536, estimated at a fast and a slow rate.
struct BitContext {
  uint16_t fast = 1 << 15, slow = 1 << 15;
  uint32_t p() const { return (uint32_t{fast} + slow) >> 5; }  // 12 bits, 0..4095
  // p as coders use it, away from the ends.
  uint32_t bounded() const { return p() < 16 ? 16 : p() > 4080 ? 4080 : p(); }
  void update(bool bit) {
    if (bit) {
      fast = static_cast<uint16_t>(fast - (fast >> 4));
      slow = static_cast<uint16_t>(slow - (slow >> 7));
    } else {
      fast = static_cast<uint16_t>(fast + ((65535 - fast) >> 4));
      slow = static_cast<uint16_t>(slow + ((65535 - slow) >> 7));
    }
  }
};

// Reads what RangeEncoder (libs/sqt_fit) wrote. Past the end it reads zeros; overrun() tells how far.
class RangeDecoder {
 public:
  static constexpr bool kEncodes = false;
  explicit RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
    for (int i = 0; i < 5; ++i) code_ = (code_ << 8) | next();
  }
  bool bit(BitContext& context, bool = false) {
    const uint32_t bound = (range_ >> 12) * context.bounded();
    const bool bit = code_ >= bound;
    if (bit) {
      code_ -= bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    context.update(bit);
    normalise();
    return bit;
  }
  bool even_bit(bool = false) {
    range_ >>= 1;
    const bool bit = code_ >= range_;
    if (bit) code_ -= range_;
    normalise();
    return bit;
  }
  size_t overrun() const { return at_ > bytes_.size() ? at_ - bytes_.size() : 0; }

 private:
  void normalise() {
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      code_ = (code_ << 8) | next();
    }
  }
  uint32_t next() {
    const size_t i = at_++;
    return i < bytes_.size() ? static_cast<uint32_t>(bytes_[i]) : 0;
  }
  std::span<const std::byte> bytes_;
  size_t at_ = 0;
  uint32_t range_ = 0xFFFFFFFFu, code_ = 0;
};

}  // namespace suite::sqt
