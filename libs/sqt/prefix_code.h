// Static prefix codes: symbols in contexts, every context with a code of its own that is made from what was counted and
// stored ahead of the symbols; raw bits go between them. Decoding a symbol is one look-up.
//
// Based on: D. A. Huffman, Proc. IRE 40, 1952; canonical codes as in RFC 1951 (Deflate).
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "base/error.h"
#include "sqt/range_decoder.h"

namespace suite::sqt {

// Numbers as a symbol and raw bits: those below `exact` are symbols of their own, larger ones share a symbol with those
// that agree in the two leading bits.
struct Token {
  uint32_t symbol, bits, raw;
};
inline Token token_of(uint32_t number, uint32_t exact) {  // number < 2^24
  if (number < exact) return {number, 0, 0};
  const uint32_t n = number - exact + 4, top = static_cast<uint32_t>(std::bit_width(n)) - 1;
  return {exact + 2 * (top - 2) + ((n >> (top - 1)) & 1), top - 1, n & ((1u << (top - 1)) - 1)};
}
inline uint32_t token_bits(uint32_t symbol, uint32_t exact) { return symbol < exact ? 0 : (symbol - exact) / 2 + 1; }
inline uint32_t token_number(uint32_t symbol, uint32_t exact, uint32_t raw) {
  if (symbol < exact) return symbol;
  const uint32_t bits = (symbol - exact) / 2 + 1;
  return exact - 4 + (((2u + ((symbol - exact) & 1)) << bits) | raw);
}

// Lengths of the codes of all contexts, [context][kSymbols]; 0: does not occur.
struct PrefixLengths {
  static constexpr uint32_t kSymbols = 56;
  static constexpr uint32_t kMost = 8;  // bits of the longest code
  std::vector<uint8_t> of;
  // Codes the lengths themselves.
  template <class Coder>
  void code(Coder& coder, size_t contexts);
};

// How large a number a symbol stands for, roughly: 0 to 3.
constexpr uint32_t size_class(uint32_t symbol) { return (symbol > 0) + (symbol > 1) + (symbol > 4); }

// Bits ahead, lowest first. Past the end it reads zeros; overrun() tells. Inner loops work on a copy.
class BitReader {
 public:
  BitReader() = default;
  explicit BitReader(std::span<const std::byte> bytes) : at_(bytes.data()), end_(bytes.data() + bytes.size()) {}
  void fill() {  // at least 32 of them
    if (count_ < 32) refill();
  }
  uint64_t ahead() const { return bits_; }
  void drop(uint32_t n) { bits_ >>= n, count_ -= n; }
  uint32_t take(uint32_t n) {  // at most 24
    fill();
    const uint32_t value = static_cast<uint32_t>(bits_) & ((1u << n) - 1);
    drop(n);
    return value;
  }
  bool overrun() const { return missing_ * 8 > count_; }

 private:
  void refill() {
    if (end_ - at_ >= 8) [[likely]] {
      uint64_t next;
      std::memcpy(&next, at_, 8);
      const uint32_t taken = (63 - count_) / 8;
      bits_ |= next << count_;
      at_ += taken, count_ += 8 * taken;
      // What the shift brought in beyond count_ comes again next time.
      bits_ &= (uint64_t{1} << count_) - 1;
    } else {
      for (; count_ <= 56; count_ += 8) {
        if (at_ < end_)
          bits_ |= std::to_integer<uint64_t>(*at_++) << count_;
        else
          ++missing_;
      }
    }
  }
  const std::byte *at_ = nullptr, *end_ = nullptr;
  uint64_t bits_ = 0;
  uint32_t count_ = 0;
  size_t missing_ = 0;
};

// Reads what PrefixEncoder (libs/sqt_fit) wrote.
class PrefixDecoder {
 public:
  static constexpr bool kEncodes = false;
  // A symbol with its length, in few bytes, so that the tables stay close.
  struct Entry {
    uint16_t bits = 0;
    Entry() = default;
    Entry(uint32_t symbol, uint32_t length)
        : bits(static_cast<uint16_t>((length + (symbol > 0)) | length << 4 | symbol << 8 | size_class(symbol) << 14)) {}
    uint32_t with_sign() const { return bits & 15u; }  // length with the sign that follows all symbols but 0
    uint32_t length() const { return (bits >> 4) & 15u; }
    uint32_t symbol() const { return (bits >> 8) & 63u; }
    uint32_t size() const { return bits >> 14; }  // size_class
  };
  static constexpr uint32_t kMask = (1u << PrefixLengths::kMost) - 1;
  // Error: lengths that are no code.
  PrefixDecoder(std::span<const std::byte> bytes, size_t contexts);
  uint32_t symbol(size_t context, uint32_t = 0) {
    bits_.fill();
    const Entry e = table(context)[bits_.ahead() & kMask];
    bits_.drop(e.length());
    return e.symbol();
  }
  uint32_t raw(uint32_t, uint32_t bits) { return bits_.take(bits); }
  uint32_t number(size_t context, uint32_t, uint32_t exact) {
    const uint32_t s = symbol(context), bits = token_bits(s, exact);
    return token_number(s, exact, bits ? bits_.take(bits) : 0);
  }
  bool overrun() const { return bits_.overrun(); }

  // By the bits ahead (kMask).
  const Entry* table(size_t context) const { return &entries_[context << PrefixLengths::kMost]; }
  BitReader& bits() { return bits_; }

 private:
  std::vector<Entry> entries_;
  BitReader bits_;
};

// The lowest `bits` bits of a code, first one last.
inline uint32_t reversed_bits(uint32_t code, uint32_t bits) {
  uint32_t r = 0;
  for (uint32_t b = 0; b < bits; ++b) r |= ((code >> b) & 1) << (bits - 1 - b);
  return r;
}

template <class Coder>
void PrefixLengths::code(Coder& coder, size_t contexts) {
  of.resize(contexts * kSymbols, 0);
  // Per context how many symbols there are, then their lengths; what the symbol had in the last context that was used
  // says most about it.
  std::array<std::array<BitContext, 64>, 1> many;
  std::array<std::array<BitContext, 16>, kMost + 1> model;
  std::array<uint8_t, kSymbols> before{};
  const auto tree = [&](auto& bits, uint32_t value, uint32_t depth) {
    uint32_t node = 1;
    for (uint32_t b = depth; b-- > 0;) node = 2 * node + (coder.bit(bits[node], (value >> b) & 1) ? 1u : 0u);
    return node - (1u << depth);
  };
  for (size_t c = 0; c < contexts; ++c) {
    uint8_t* length = &of[c * kSymbols];
    uint32_t n = kSymbols;
    while (n > 0 && !length[n - 1]) --n;
    n = tree(many[0], n, 6);
    if (n > kSymbols) throw Error("SQT payload is damaged: a code with too many symbols");
    for (uint32_t s = 0; s < n; ++s) {
      length[s] = static_cast<uint8_t>(tree(model[before[s]], length[s], 4));
      if (length[s] > kMost) throw Error("SQT payload is damaged: a code that is too long");
    }
    if (n) std::copy_n(length, kSymbols, before.begin());
  }
}

}  // namespace suite::sqt
