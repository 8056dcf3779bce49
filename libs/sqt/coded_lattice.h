// The pyramid that encoder and decoder of the aligned method rebuild together, in whole numbers: nodes of one sheet,
// level by level, with the smooth prediction of children from their parents.
//
// A node carries a row (channel x view) of log2 averages in units of 2^-fraction_bits about an offset. Its slopes are
// limited central differences over the four edge neighbours; children are predicted by the plane through the parent. A
// neighbour that was not divided so far stands in with its own plane. All arithmetic is on 16 bits, so every machine
// rebuilds the same numbers.
//
// Based on: average-interpolating pyramids (S + P transform: Said & Pearlman, IEEE TIP 5, 1996); limiter: van Leer
// 1977.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sqt/log_scale.h"
#include "sqt/region.h"
#include "sqt/vectors.h"

namespace suite::sqt {

class CodedLattice {
 public:
  static constexpr int kRootOrder = Region::kRootOrder;
  // A node that covers the cell across an edge: of the same order, or coarser; then the cell's centre lies
  // (x, y) / 2^(orders between + 1) cell widths from the node's.
  struct Link {
    int32_t node = -1;  // -1: the region ends
    int16_t x = 0, y = 0;
  };
  struct Node {
    CellXY at;
    int order = 0;
    int32_t parent = -1, first_child = -1;  // children that the region holds, in nested order
    uint8_t child_count = 0, child_mask = 0;
    bool split = false;  // to be divided; the caller's
    Link link[4];        // -x, +x, -y, +y
    CellId id() const { return cell_at(order, at); }
  };
  CodedLattice(Region region, size_t width);  // width: numbers per node

  size_t size() const { return nodes_.size(); }
  Node& node(size_t i) { return nodes_[i]; }
  const Node& node(size_t i) const { return nodes_[i]; }
  size_t row() const { return row_; }  // numbers in a padded row
  int16_t* value(size_t i) { return &values_[i * row_]; }
  const int16_t* value(size_t i) const { return &values_[i * row_]; }
  const int16_t* slope(size_t i, size_t axis) const { return &slopes_[(2 * i + axis) * row_]; }

  void reserve(size_t nodes);
  // Appends the children of a node, with values that are its plane plus the details (x, y, xy differences; null: none).
  // Slopes of i must be known.
  void divide(size_t i, const int16_t* const details[3]);
  // Links of the nodes [begin, end), a level; those of the level above must be known and all its children made.
  void link(size_t begin, size_t end);
  // Slopes of a node from the values of its level and the planes above.
  void find_slopes(size_t i);
  // How many of the four links lead to divided nodes of the same order.
  int divided_around(size_t i) const;
  // What divide() would give child k without details, as numbers of the scale.
  int predicted(size_t i, uint32_t k, size_t column) const;

 private:
  Link find_link(const Node& node, size_t edge) const;
  const int16_t* across(const Node& node, size_t edge, int16_t* room) const;
  int16_t* slope_row(size_t i, size_t axis) { return &slopes_[(2 * i + axis) * row_]; }
  Region region_;
  size_t row_;
  Lent<std::vector<Node>, CodedLattice> nodes_;
  struct Slopes;
  Lent<UnsetVector<int16_t>, CodedLattice> values_;  // [node][row]
  Lent<UnsetVector<int16_t>, Slopes> slopes_;        // [node]{x, y}[row]
  UnsetVector<int16_t> room_;                        // two rows
};

}  // namespace suite::sqt
