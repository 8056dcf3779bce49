#include "estimate/block_counts.h"

#include <algorithm>

#include "base/error.h"

namespace suite {

namespace {

constexpr size_t kCounts = RunStatistics::kCounts;

void add_to(std::span<uint64_t> counts, const RunStatistics& took) {
  const auto more = took.counts();
  for (size_t i = 0; i < kCounts; ++i) counts[i] += more[i];
}

}  // namespace

BlockCounts::BlockCounts(uint32_t columns, uint32_t rows, int scrambles)
    : columns_(columns),
      scrambles_(scrambles),
      blocks_(blocks_of(columns, rows)),
      counts_(blocks_.size() * width()),
      pilots_(blocks_.size() * kCounts) {}

void BlockCounts::add(const Block& block, const Accumulators& before, const Accumulators& part,
                      const RunStatistics& took) {
  for (int s = 0; s < scrambles_; ++s)
    for (size_t i = 0; i < block.problems(); ++i)
      if (part.taken(i, s) > before.taken(problem_at(columns_, block, i), s))
        return add_to(of(number_of(block, columns_)).subspan(static_cast<size_t>(s) * kCounts, kCounts), took);
}

void BlockCounts::add_pilot(const Block& block, const RunStatistics& took) {
  add_to(pilot(number_of(block, columns_)), took);
}

void BlockCounts::join(const BlockCounts& other, const Accumulators& mine, const Accumulators& theirs) {
  SUITE_CHECK(other.blocks() == blocks() && other.scrambles() <= scrambles());
  for (size_t b = 0; b < blocks(); ++b)
    for (int s = 0; s < other.scrambles(); ++s) {
      uint64_t here = 0, there = 0;
      for (size_t i = 0; i < blocks_[b].problems(); ++i) {
        const size_t problem = problem_at(columns_, blocks_[b], i);
        here += mine.taken(problem, s), there += theirs.taken(problem, s);
      }
      const size_t at = static_cast<size_t>(s) * kCounts;
      if (there > here) std::copy_n(&other.of(b)[at], kCounts, &of(b)[at]);
    }
}

void BlockCounts::join_pilot(const BlockCounts& other, size_t block) {
  std::copy_n(other.pilot(block).data(), kCounts, pilot(block).data());
}

RunStatistics BlockCounts::total() const {
  RunStatistics sum;
  for (const auto* all : {&counts_, &pilots_})
    for (size_t i = 0; i < all->size(); i += kCounts)
      sum.add_counts(std::span<const uint64_t, kCounts>(&(*all)[i], kCounts));
  return sum;
}

}  // namespace suite
