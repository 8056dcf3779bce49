#include "heat/cell_cuts.h"

#include <algorithm>

namespace suite {

void CellCuts::add(uint32_t cell, Vec2 p, Vec2 q, uint32_t other) {
  if (first_.size() <= std::max(cell, other))
    first_.resize(std::max(cell, other) + 1, kNone), last_.resize(first_.size(), kNone);
  const auto number = static_cast<uint32_t>(cuts_.size());
  cuts_.push_back({p, q, other, kNone});
  (first_[cell] == kNone ? first_[cell] : cuts_[last_[cell]].next) = number;
  last_[cell] = number;
}

uint32_t CellCuts::find(uint32_t cell, Vec2 at) const {
  for (uint32_t c = cut(cell) ? first_[cell] : kNone; c != kNone;) {
    const Cut& line = cuts_[c];
    const double side = (line.q.x - line.p.x) * (at.y - line.p.y) - (line.q.y - line.p.y) * (at.x - line.p.x);
    if (side >= 0) {
      c = line.next;
    } else {
      cell = line.other;
      c = first_[cell];
    }
  }
  return cell;
}

}  // namespace suite
