// The syntax of the aligned method's symbols: which nodes are divided, and the quantised levels of a node's
// differences, each in the context of levels that are known already. Internal to libs/sqt and libs/sqt_fit.
//
// A block has rows (detail x channel frequency) of levels over view frequencies. Of channels: how many have any level
// but 0, then for each of these which details have; of a row: how many levels up to the last one that is not 0, then
// these, sign after number. Contexts: levels of the same place in the block of the node above, in the detail and the
// channel before, and the level before. Bodies of the templates are in block_code_coders.h.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sqt/aligned.h"
#include "sqt/prefix_code.h"
#include "sqt/vectors.h"

namespace suite::sqt {

class BlockTransform;

class BlockCode {
 public:
  // Of all kinds; the last are those of code_finer, which plain layouts have not.
  static constexpr size_t kContexts = 170, kPlainContexts = 160;
  static constexpr int kMostFiner = 31;
  static size_t contexts_of(const AlignedLayout& layout) { return layout.refined ? kContexts : kPlainContexts; }
  BlockCode(const AlignedLayout& layout, const BlockTransform& transform);

  // Levels [detail][channel][view] of the root that comes next (one detail), or of a divided node (three). above: the
  // block of the node above, -1 for none. Returns the number of the new block. Levels behind a row's count are not
  // written when decoding.
  template <class Coder>
  int32_t code(Coder& coder, std::span<int32_t> levels, size_t details, int32_t above);
  // How many levels count, [detail][channel] of a block.
  const uint16_t* counts(int32_t block) const { return &counts_[static_cast<size_t>(block) * 3 * channels_]; }
  // Which children of a node are divided; block: of the node; around: of its neighbours, how many are divided (0..4).
  template <class Coder>
  uint32_t code_split(Coder& coder, uint32_t mask, int32_t block, int around);
  // Octaves by which a node's step is finer than its values say; above: of the node above, -1: a root.
  template <class Coder>
  uint32_t code_finer(Coder& coder, uint32_t octaves, int above) {
    const uint32_t n = coder.symbol(kPlainContexts + static_cast<size_t>(above < 9 ? above + 1 : 9), octaves);
    return n < kMostFiner ? n : kMostFiner;
  }

 private:
  uint8_t* sizes(int32_t block) { return &sizes_[static_cast<size_t>(block) * 3 * channels_ * stride_]; }
  template <class Coder>
  void code_rows(Coder& coder, std::span<int32_t> levels, size_t details, int32_t above, int32_t block);
  template <class Coder>
  void code_row(Coder& coder, int32_t* row, size_t n, uint8_t* size);
  template <class Coder>
  void code_root(Coder& coder, int32_t* row, size_t n);
  void find_contexts(const uint8_t* up, const uint8_t* detail, const uint8_t* channel, size_t n);
  size_t views_, channels_, stride_;
  std::vector<uint8_t> place_;    // [view frequency]: part of the context, how high it is
  std::vector<uint8_t> context_;  // room: of a row
  std::vector<uint8_t> nothing_;  // a row of zeros
  Lent<UnsetVector<uint8_t>, BlockCode>
      sizes_;  // [block][detail][channel][stride]: |level|, at most kCap; filled up with zeros, and 32 more
  Lent<UnsetVector<uint16_t>, BlockCode> counts_;  // [block][detail][channel]
};

}  // namespace suite::sqt
