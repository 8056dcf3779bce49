// An adaptive quad-tree over the cells of the sphere: which leaf holds a direction.
//
// Assumes: leaves are disjoint and together cover each face they touch; faces (or quarters) without any leaf are
// "absent". Based on: Goodenough & Brown, section IV-D-4.
#pragma once
#include <span>
#include <vector>

#include "sqt/cell.h"

namespace suite::sqt {

class Tree {
 public:
  Tree() = default;
  // leaves: disjoint cells in any order; leaf i of the tree is leaves[i]. Bug when two of them overlap.
  explicit Tree(std::span<const CellId> leaves);

  // Index of the leaf that holds the point, or -1 where the tree has none.
  int leaf(FacePoint p) const {
    const uint32_t x = static_cast<uint32_t>(p.x * (1 << kMaxOrder)), y = static_cast<uint32_t>(p.y * (1 << kMaxOrder));
    constexpr int kShift = kMaxOrder - kTopOrder;
    int node = top_[(static_cast<size_t>(p.face) << (2 * kTopOrder)) + ((y >> kShift) << kTopOrder) + (x >> kShift)];
    for (int bit = kShift - 1; node > 0; --bit)
      node = nodes_[static_cast<size_t>(node) + (((y >> bit) & 1) * 2 + ((x >> bit) & 1))];
    return -node - 1;
  }
  size_t size() const { return cells_.size(); }
  CellId cell(size_t leaf) const { return cells_[leaf]; }
  std::span<const CellId> cells() const { return cells_; }

 private:
  static constexpr int kTopOrder = 4;  // a flat table stands for the upper levels
  std::vector<CellId> cells_;
  std::vector<int> nodes_ = std::vector<int>(12, 0);  // > 0 first of four children, 0 absent, < 0 leaf -(index + 1)
  std::vector<int> top_ = std::vector<int>(12u << (2 * kTopOrder), 0);
};

}  // namespace suite::sqt
