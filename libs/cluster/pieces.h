// What a thread fetches: some scrambles of a block of a round. Not a public header.
#pragma once
#include <span>
#include <unordered_map>
#include <vector>

#include "scheduler/executor.h"

namespace suite::cluster {

struct Piece {
  uint32_t round = 0, block = 0;  // places in the rounds of a run and in the blocks of a round
  Scrambles scrambles = kAllScrambles;
  uint8_t of = 1;         // pieces of this block
  uint8_t continues = 0;  // whether the block has sums already
};

// What blocks cost, from what they took before.
class Costs {
 public:
  void note(const Capture& capture, size_t block, const RunStatistics& took);
  // Cycles a path of a block; 1 for all blocks of a capture of which nothing is known.
  double per_path(const Capture& capture, size_t block) const;
  // Keeps only the captures of these rounds.
  void keep(std::span<const Round> rounds);

 private:
  std::unordered_map<const Capture*, std::vector<float>> known_;  // [block]; 0 = not known
};

// The pieces of all rounds, dearest first (equal ones in the order of the rounds). Blocks that are so dear that
// `threads` threads could not finish together are cut by scrambles.
std::vector<Piece> pieces_of(std::span<const Round> rounds, const Costs& costs, size_t threads);

}  // namespace suite::cluster
