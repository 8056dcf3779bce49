#include "sqt/prefix_code.h"

#include <algorithm>

#include "base/error.h"

namespace suite::sqt {

constexpr uint32_t kSymbols = PrefixLengths::kSymbols, kPrefixCodeMost = PrefixLengths::kMost;

PrefixDecoder::PrefixDecoder(std::span<const std::byte> bytes, size_t contexts) {
  if (bytes.size() < 2) throw Error("SQT payload is damaged: it ends too early");
  const size_t head = std::to_integer<size_t>(bytes[0]) + 256 * std::to_integer<size_t>(bytes[1]);
  if (head > bytes.size() - 2) throw Error("SQT payload is damaged: it ends too early");
  PrefixLengths lengths;
  RangeDecoder coder(bytes.subspan(2, head));
  lengths.code(coder, contexts);
  if (coder.overrun() > 8) throw Error("SQT payload is damaged: it ends too early");
  bits_ = BitReader(bytes.subspan(2 + head));
  // What no code leads to, in damaged files alone, reads as symbol 0.
  entries_.assign(contexts << kPrefixCodeMost, Entry(0, kPrefixCodeMost));
  for (size_t c = 0; c < contexts; ++c) {
    const uint8_t* length = &lengths.of[c * kSymbols];
    if (std::all_of(length, length + kSymbols, [](uint8_t l) { return l == 0; })) continue;
    uint32_t next = 0;  // as the encoder counts them
    uint32_t n = kSymbols;
    while (n > 0 && !length[n - 1]) --n;
    for (uint32_t b = 1; b <= kPrefixCodeMost; ++b, next <<= 1)
      for (uint32_t s = 0; s < n; ++s) {
        if (length[s] != b) continue;
        if (next >= 1u << b) throw Error("SQT payload is damaged: lengths that make no code");
        for (uint32_t i = reversed_bits(next, b); i <= kMask; i += 1u << b)
          entries_[(c << kPrefixCodeMost) + i] = {s, b};
        ++next;
      }
  }
}

}  // namespace suite::sqt
