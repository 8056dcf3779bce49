// What the blocks of a capture took, block by block, so that the work of parts that were computed apart is counted once
// each when they are joined.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "estimate/accumulators.h"
#include "estimate/block.h"
#include "estimate/statistics.h"

namespace suite {

// What a run of a block took is kept with the first of the scrambles that it continued: whoever went furthest with a
// scramble of a block brings the counts that stand there, as it brings the sums.
class BlockCounts {
 public:
  // columns, rows: of the capture.
  BlockCounts(uint32_t columns, uint32_t rows, int scrambles);
  size_t blocks() const { return blocks_.size(); }
  int scrambles() const { return scrambles_; }
  // A block was continued: from the sums `before` (of the capture) to those of `part`, which stand by place.
  void add(const Block& block, const Accumulators& before, const Accumulators& part, const RunStatistics& took);
  // So was a pilot that is thrown away.
  void add_pilot(const Block& block, const RunStatistics& took);
  // Takes over what another counted further; before `mine` is joined with `theirs`, the sums that belong to them.
  void join(const BlockCounts& other, const Accumulators& mine, const Accumulators& theirs);
  void join_pilot(const BlockCounts& other, size_t block);
  RunStatistics total() const;

  // As they are stored: RunStatistics::kCounts numbers for each scramble of a block, and for its thrown-away pilot.
  std::span<uint64_t> of(size_t block) { return {&counts_[block * width()], width()}; }
  std::span<const uint64_t> of(size_t block) const { return {&counts_[block * width()], width()}; }
  std::span<uint64_t> pilot(size_t block) { return {&pilots_[block * kCounts], kCounts}; }
  std::span<const uint64_t> pilot(size_t block) const { return {&pilots_[block * kCounts], kCounts}; }

 private:
  static constexpr size_t kCounts = RunStatistics::kCounts;
  size_t width() const { return kCounts * static_cast<size_t>(scrambles_); }
  uint32_t columns_;
  int scrambles_;
  std::vector<Block> blocks_;
  std::vector<uint64_t> counts_, pilots_;  // [block][scramble][count], [block][count]
};

}  // namespace suite
