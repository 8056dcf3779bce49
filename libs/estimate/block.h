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
std::vector<Block> blocks_of(uint32_t columns, uint32_t rows);
inline std::vector<Block> blocks_of(const Capture& capture) { return blocks_of(capture.columns, capture.rows); }
// The place of a block among them.
inline size_t number_of(const Block& block, uint32_t columns) {
  return size_t{block.row / kBlockEdge} * ((columns + kBlockEdge - 1) / kBlockEdge) + block.column / kBlockEdge;
}

// Where the accumulators of a block's problems stand: at their own numbers, for accumulators of a whole capture, or at
// their places in the block, for accumulators of one block.
enum class Slots : uint8_t { by_problem, by_place };
// The problem at a place of a block: its places are counted row by row.
inline size_t problem_at(uint32_t columns, const Block& block, size_t place) {
  return (block.row + place / block.columns) * columns + block.column + place % block.columns;
}
inline size_t problem_at(const Capture& capture, const Block& block, size_t place) {
  return problem_at(capture.columns, block, place);
}

}  // namespace suite
