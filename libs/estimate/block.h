// The pieces in which a capture is run.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimate/deal.h"
#include "sensor/sensor.h"

namespace suite {

// A rectangle of problems that run together, and the scrambles of them that do.
struct Block {
  uint32_t column = 0, row = 0, columns = 0, rows = 0;
  Scrambles scrambles = kAllScrambles;
  size_t problems() const { return size_t{columns} * rows; }
};
// Square blocks that cover a capture, row by row.
inline constexpr uint32_t kBlockEdge = 8;
std::vector<Block> blocks_of(const Capture& capture);

// Where the accumulators of a block's problems stand: at their own numbers, for accumulators of a whole capture, or at
// their places in the block, for accumulators of one block.
enum class Slots : uint8_t { by_problem, by_place };
// The problem at a place of a block: its places are counted row by row.
inline size_t problem_at(const Capture& capture, const Block& block, size_t place) {
  return (block.row + place / block.columns) * capture.columns + block.column + place % block.columns;
}

}  // namespace suite
