// Cells that were cut in two, again and again, by lines in their own two coordinates: which one a place is in.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace suite {

class CellCuts {
 public:
  // Of what is on the left of the line from p to q the cell stays, what is on its right is `other`.
  void add(uint32_t cell, Vec2 p, Vec2 q, uint32_t other);
  // The cell of a place that was in `cell` before it was cut.
  uint32_t find(uint32_t cell, Vec2 at) const;
  bool cut(uint32_t cell) const { return cell < first_.size() && first_[cell] != kNone; }

 private:
  struct Cut {
    Vec2 p, q;
    uint32_t other, next;  // the next cut of what stayed
  };
  std::vector<Cut> cuts_;
  std::vector<uint32_t> first_, last_;  // by cell
};

}  // namespace suite
