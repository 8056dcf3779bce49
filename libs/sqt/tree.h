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
  // leaves: disjoint cells in any order, fewer than 2^27; leaf i of the tree is leaves[i]. Bug when two of them
  // overlap.
  explicit Tree(std::span<const CellId> leaves);

  struct Found {
    int leaf = -1;  // index, or -1 where the tree has none
    int order = 0;  // of the leaf
  };
  Found find(FacePoint p) const {
    const uint32_t x = static_cast<uint32_t>(p.x * (1 << kMaxOrder)), y = static_cast<uint32_t>(p.y * (1 << kMaxOrder));
    int shift = kMaxOrder - kTopOrder;
    int entry = entries_[(static_cast<size_t>(p.face) << (2 * kTopOrder)) + ((y >> shift) << kTopOrder) + (x >> shift)];
    while (entry > 0) {
      shift -= kStride;
      entry = entries_[static_cast<size_t>(entry) + (((y >> shift) & kMask) << kStride) + ((x >> shift) & kMask)];
    }
    const int code = -entry - 1;
    return {code >> 4, code & 15};  // code -1 (absent) stays negative
  }
  int leaf(FacePoint p) const { return find(p).leaf; }
  size_t size() const { return cells_.size(); }
  CellId cell(size_t leaf) const { return cells_[leaf]; }
  std::span<const CellId> cells() const { return cells_; }

 private:
  // A flat table stands for the upper levels; every table below it for three more.
  static constexpr int kTopOrder = 4, kStride = 3;
  static constexpr uint32_t kMask = (1u << kStride) - 1;
  static_assert((kMaxOrder - kTopOrder) % kStride == 0);
  std::vector<CellId> cells_;
  // > 0 where the next table starts, 0 absent, < 0 leaf: -(16 leaf + order) - 1.
  std::vector<int> entries_ = std::vector<int>(12u << (2 * kTopOrder), 0);
};

}  // namespace suite::sqt
