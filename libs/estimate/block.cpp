#include "estimate/block.h"

#include <algorithm>

namespace suite {

std::vector<Block> blocks_of(const Capture& capture) {
  std::vector<Block> blocks;
  for (uint32_t r = 0; r < capture.rows; r += kBlockEdge)
    for (uint32_t c = 0; c < capture.columns; c += kBlockEdge)
      blocks.push_back({c, r, std::min(kBlockEdge, capture.columns - c), std::min(kBlockEdge, capture.rows - r)});
  return blocks;
}

}  // namespace suite
