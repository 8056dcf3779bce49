// Bodies of BlockCode's templates, for those who instantiate them: block_code.cpp for the decoder, libs/sqt_fit for the
// encoder, which brings its own code_level. Internal to libs/sqt and libs/sqt_fit.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdlib>

#include "sqt/block_code.h"

namespace suite::sqt {

namespace block_code {

inline constexpr uint32_t kCap = 31;                                              // of what contexts see of a level
inline constexpr uint32_t kExactLevel = 12, kExactCount = 8, kExactChannels = 4;  // token_of
inline constexpr size_t kClasses = 8, kPlaces = 3, kBefore = 4;

// Where the contexts of a kind begin.
inline constexpr size_t kLevel = 0, kLast = kLevel + kClasses * kPlaces * kBefore, kRootLevel = kLast + kClasses,
                        kRootCount = kRootLevel + 2, kCount = kRootCount + 1, kMask = kCount + 12,
                        kChannels = kMask + 15, kSplit = kChannels + 5;
static_assert(kSplit + 20 <= BlockCode::kPlainContexts);

inline size_t count_class(size_t n) { return n == 0 ? 0 : n <= 2 ? 1 : n <= 6 ? 2 : n <= 12 ? 3 : 4; }

// Codes of one kind of context, by a copy of a decoder's bits.
struct LevelReader {
  const PrefixDecoder::Entry* codes;
  BitReader bits;
};
struct LevelSymbol {
  uint32_t symbol, size;
};
// One level.
inline LevelSymbol code_level(LevelReader& from, int32_t& level, size_t context) {
  from.bits.fill();
  const PrefixDecoder::Entry e =
      from.codes[(context << PrefixLengths::kMost) + (from.bits.ahead() & PrefixDecoder::kMask)];
  const int32_t sign = -static_cast<int32_t>((from.bits.ahead() >> e.length()) & (e.with_sign() - e.length()));
  from.bits.drop(e.with_sign());
  const uint32_t symbol = e.symbol();
  uint32_t size = symbol;
  if (size >= kExactLevel) [[unlikely]]
    size = token_number(symbol, kExactLevel, from.bits.take(token_bits(symbol, kExactLevel)));
  level = (static_cast<int32_t>(size) ^ sign) - sign;
  return {symbol, e.size()};
}

}  // namespace block_code

using namespace block_code;

template <class From>
void code_levels(From& from, int32_t* row, size_t n, const uint8_t* context, uint8_t* size) {
  uint32_t before = 0;
  for (size_t k = 0; k + 1 < n; ++k) {
    const LevelSymbol s = code_level(from, row[k], kLevel + context[k] + before);
    before = s.size;
    size[k] = static_cast<uint8_t>(std::min<uint32_t>(s.symbol, kCap));
  }
  const LevelSymbol s = code_level(from, row[n - 1], kLast + context[n - 1] / (kPlaces * kBefore));
  size[n - 1] = static_cast<uint8_t>(std::min<uint32_t>(s.symbol, kCap));
}

template <class Coder>
void BlockCode::code_row(Coder& coder, int32_t* row, size_t n, uint8_t* size) {
  if constexpr (Coder::kEncodes) {
    code_levels(coder, row, n, context_.data(), size);
  } else {
    LevelReader from{coder.table(0), coder.bits()};
    code_levels(from, row, n, context_.data(), size);
    coder.bits() = from.bits;
  }
}

template <class Coder>
void BlockCode::code_rows(Coder& coder, std::span<int32_t> levels, size_t details, int32_t above, int32_t block) {
  const uint16_t* counts_above = above >= 0 ? counts(above) : nullptr;
  uint16_t* count = &counts_[static_cast<size_t>(block) * 3 * channels_];
  auto mask_of = [&](const uint16_t* n, size_t c) {
    uint32_t mask = 0;
    for (size_t d = 0; d < 3; ++d) mask |= n[d * channels_ + c] ? 1u << d : 0;
    return mask;
  };
  size_t channels = 0, channels_above = 0;
  for (size_t c = 0; c < channels_; ++c) {
    if (Coder::kEncodes && mask_of(count, c)) channels = c + 1;
    if (counts_above && mask_of(counts_above, c)) channels_above = c + 1;
  }
  channels = coder.number(kChannels + (counts_above ? std::min<size_t>(3, channels_above) : 4),
                          static_cast<uint32_t>(channels), kExactChannels);
  channels = std::min(channels, channels_);  // damaged files
  for (size_t c = 0; c < channels; ++c) {
    const size_t context = kMask + std::min<size_t>(c, 2) * 5 +
                           (counts_above ? static_cast<size_t>(std::popcount(mask_of(counts_above, c))) : 4);
    const uint32_t mask = coder.symbol(context, mask_of(count, c));
    for (size_t d = 0; d < details; ++d) {
      if (!(mask & (1u << d))) continue;
      const size_t row = d * channels_ + c;
      const size_t known = counts_above ? count_class(counts_above[row]) : 5;
      const uint32_t n =
          coder.number(kCount + (c > 0 ? 6 : 0) + known, static_cast<uint32_t>(count[row] - 1), kExactCount) + 1;
      count[row] = static_cast<uint16_t>(std::min<size_t>(n, views_));
      uint8_t* size = sizes(block) + row * stride_;
      find_contexts(above >= 0 ? sizes(above) + row * stride_ : nothing_.data(),
                    d > 0 ? size - channels_ * stride_ : nothing_.data(), c > 0 ? size - stride_ : nothing_.data(),
                    count[row]);
      code_row(coder, &levels[row * views_], count[row], size);
    }
  }
}

template <class Coder>
void BlockCode::code_root(Coder& coder, int32_t* row, size_t n) {
  if constexpr (Coder::kEncodes) {
    for (size_t k = 0; k < n; ++k) code_level(coder, row[k], kRootLevel + (k > 2));
  } else {
    LevelReader from{coder.table(0), coder.bits()};
    for (size_t k = 0; k < n; ++k) code_level(from, row[k], kRootLevel + (k > 2));
    coder.bits() = from.bits;
  }
}

template <class Coder>
int32_t BlockCode::code(Coder& coder, std::span<int32_t> levels, size_t details, int32_t above) {
  const size_t rows = 3 * channels_, block = counts_.size() / rows;
  counts_.resize((block + 1) * rows);
  sizes_.resize((block + 1) * rows * stride_ + 32);
  std::fill_n(&counts_[block * rows], rows, uint16_t{0});
  std::fill_n(&sizes_[block * rows * stride_], rows * stride_ + 32, uint8_t{0});
  uint16_t* count = &counts_[block * rows];
  if constexpr (Coder::kEncodes)
    for (size_t r = 0; r < details * channels_; ++r) {
      size_t n = views_;
      while (n > 0 && levels[r * views_ + n - 1] == 0) --n;
      count[r] = static_cast<uint16_t>(n);
    }
  if (details == 3) {
    code_rows(coder, levels, details, above, static_cast<int32_t>(block));
  } else {
    for (size_t c = 0; c < channels_; ++c) {
      count[c] = static_cast<uint16_t>(std::min<size_t>(views_, coder.number(kRootCount, count[c], kExactCount)));
      code_root(coder, &levels[c * views_], count[c]);
    }
  }
  return static_cast<int32_t>(block);
}

template <class Coder>
uint32_t BlockCode::code_split(Coder& coder, uint32_t mask, int32_t block, int around) {
  size_t levels = 0;
  for (size_t r = 0; r < 3 * channels_; ++r) levels += counts(block)[r];
  const size_t busy = levels == 0 ? 0 : levels <= 8 ? 1 : levels <= 30 ? 2 : 3;
  return coder.symbol(kSplit + busy * 5 + static_cast<size_t>(around), mask);
}

}  // namespace suite::sqt
