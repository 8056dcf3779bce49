// The writing side of the static prefix codes; see sqt/prefix_code.h.
#pragma once
#include "sqt/prefix_code.h"

namespace suite::sqt {

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

}  // namespace suite::sqt
