// Sums of a block as they travel between ranks of the same program. Not a public header.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "estimate/accumulators.h"
#include "estimate/block.h"
#include "estimate/statistics.h"

namespace suite::cluster {

struct Head {
  uint32_t piece = 0;
  RunStatistics statistics;
};

// The rows of some scrambles of the first `problems` problems.
std::vector<std::byte> pack(const Head& head, const Accumulators& sums, size_t problems, Scrambles scrambles);
Head head_of(std::span<const std::byte> bytes);
// Puts the rows where they stood; of the same shape, problems and scrambles as what was packed.
void unpack(std::span<const std::byte> bytes, size_t problems, Scrambles scrambles, Accumulators& sums);

}  // namespace suite::cluster
