#include "estimate/block.h"

#include <algorithm>

namespace suite {

std::vector<Block> blocks_of(uint32_t columns, uint32_t rows) {
  std::vector<Block> blocks;
  for (uint32_t r = 0; r < rows; r += kBlockEdge)
    for (uint32_t c = 0; c < columns; c += kBlockEdge)
      blocks.push_back({c, r, std::min(kBlockEdge, columns - c), std::min(kBlockEdge, rows - r)});
  return blocks;
}

}  // namespace suite
