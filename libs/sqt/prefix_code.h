// Static prefix codes: symbols in contexts, every context with a code of its own that is made from what was counted and
// stored ahead of the symbols; raw bits go between them. Decoding a symbol is one look-up.
//
// Based on: D. A. Huffman, Proc. IRE 40, 1952; canonical codes as in RFC 1951 (Deflate).
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "sqt/range_coder.h"

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

class PrefixEncoder {
 public:
  static constexpr bool kEncodes = true;
  explicit PrefixEncoder(size_t contexts) : contexts_(contexts) {}
  // Takes note of a symbol (< kSymbols); returns it.
  uint32_t symbol(size_t context, uint32_t symbol) {
    noted_.push_back({static_cast<uint16_t>(context), static_cast<uint8_t>(symbol), 0, 0});
    return symbol;
  }
  // Raw bits (at most 24), to follow the last symbol or the raw bits before; returns them.
  uint32_t raw(uint32_t value, uint32_t bits) {
    noted_.push_back({kRaw, 0, static_cast<uint8_t>(bits), value});
    return value;
  }
  uint32_t number(size_t context, uint32_t number, uint32_t exact) {
    const Token t = token_of(number, exact);
    symbol(context, t.symbol);
    if (t.bits) raw(t.raw, t.bits);
    return number;
  }
  // u16 length of the codes' lengths, these, then the symbols.
  std::vector<std::byte> finish() const;

 private:
  static constexpr uint16_t kRaw = 0xFFFF;
  struct Note {
    uint16_t context;
    uint8_t symbol, bits;
    uint32_t value;
  };
  size_t contexts_;
  std::vector<Note> noted_;
};

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

// Reads what PrefixEncoder wrote.
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

}  // namespace suite::sqt
