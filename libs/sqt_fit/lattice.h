// The pyramid of averages that the encoder of the aligned method works from: nodes of one sheet, level by level, with
// the smooth prediction of children from their parents.
//
// A node carries a vector (view x channel) of log2 averages. Its slopes are limited central differences over the four
// edge neighbours; children are predicted by the plane through the parent. A neighbour that was not divided so far
// stands in with its own plane.
//
// Based on: average-interpolating pyramids (S + P transform: Said & Pearlman, IEEE TIP 5, 1996); limiter: van Leer
// 1977.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sqt/region.h"

namespace suite::sqt {

class Lattice {
 public:
  static constexpr int kRootOrder = Region::kRootOrder;
  Lattice(Region region, size_t width);  // width: numbers per node

  struct Node {
    CellId id;
    int32_t first_child = -1;  // children that the region holds, in nested order, `child_count` of them
    uint8_t child_count = 0;
    uint8_t child_mask = 0;
  };
  size_t size() const { return nodes_.size(); }
  const Node& node(size_t i) const { return nodes_[i]; }
  std::span<float> value(size_t i) { return {&value_[i * width_], width_}; }
  std::span<const float> value(size_t i) const { return {&value_[i * width_], width_}; }
  std::span<const float> values() const { return value_; }  // [node][width]
  std::span<const float> slope(size_t i, int axis) const {
    return {&slope_[(2 * i + static_cast<size_t>(axis)) * width_], width_};
  }

  void reserve(size_t nodes);
  // Appends the children of a node (values unset); their slopes and values are the caller's to fill, all values of a
  // level before compute_slopes of that level.
  void divide(size_t i);
  // How many of the four edge neighbours are known to be divided (0..4); for contexts.
  int divided_around(size_t i) const;
  // Slopes of the nodes [begin, end) from all values known so far.
  void compute_slopes(size_t begin, size_t end);
  // The plane of node i at child k's centre: value + (+-) slope / 4.
  void predict(size_t i, uint32_t k, std::span<float> out) const;

 private:
  int32_t find(CellId id) const;  // -1: not there
  // Value at a cell of the node's level, or of a coarser plane (computed into room); null where the region ends.
  const float* estimate(CellId id, std::span<float> room) const;
  Region region_;
  size_t width_;
  std::vector<Node> nodes_;
  std::vector<float> value_, slope_;
  std::vector<uint64_t> table_;  // open addressing: code << 32 | index + 1
  void insert(CellId id, size_t index);
};

}  // namespace suite::sqt
