#include "sqt/block_code_coders.h"

#include <algorithm>
#include <array>
#include <bit>

#include "sqt/block_transform.h"

namespace suite::sqt {

namespace {

// Class of the levels around: of the weighted sum of their sizes.
using Bytes = uint8_t __attribute__((vector_size(32)));
Bytes class_of(Bytes s) {
  Bytes n{};
  for (const uint8_t bound : {0, 1, 2, 4, 7, 12, 24}) n -= reinterpret_cast<Bytes>(s > bound);
  return n;
}
}  // namespace

BlockCode::BlockCode(const AlignedLayout& layout, const BlockTransform& transform)
    : views_(layout.views()), channels_(layout.channels), stride_((views_ + 32) / 32 * 32) {
  for (size_t k = 0; k < views_; ++k)
    place_.push_back(static_cast<uint8_t>(kBefore * (transform.height(k) == 0 ? 0 : transform.height(k) < 4 ? 1 : 2)));
  place_.resize(stride_);
  context_.resize(stride_);
  nothing_.assign(stride_ + 32, 0);
}

// Of the first n places of a row. Rows end in a zero at least, so the level one further up is always there.
void BlockCode::find_contexts(const uint8_t* up, const uint8_t* detail, const uint8_t* channel, size_t n) {
  for (size_t k = 0; k < n; k += 32) {
    const Bytes above = load<Bytes>(up + k);
    Bytes next{};
    std::memcpy(&next, up + k + 1, sizeof next);
    const Bytes sum = above + above + next + load<Bytes>(detail + k) + load<Bytes>(channel + k);
    store(&context_[k], class_of(sum) * (kPlaces * kBefore) + load<Bytes>(&place_[k]));
  }
}

template int32_t BlockCode::code(PrefixDecoder&, std::span<int32_t>, size_t, int32_t);
template uint32_t BlockCode::code_split(PrefixDecoder&, uint32_t, int32_t, int);

}  // namespace suite::sqt
