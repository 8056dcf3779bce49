#include "sqt/tree.h"

#include "base/error.h"

namespace suite::sqt {

Tree::Tree(std::span<const CellId> leaves) : cells_(leaves.begin(), leaves.end()) {
  SUITE_CHECK(cells_.size() < (size_t{1} << 27));
  for (size_t i = 0; i < cells_.size(); ++i) {
    const int order = cells_[i].order();
    const CellXY at = xy_of(cells_[i]);
    const int leaf = -(16 * static_cast<int>(i) + order) - 1;
    // Go down through full tables to the one whose entries are as fine as the leaf or finer.
    size_t table = static_cast<size_t>(at.face) << (2 * kTopOrder);
    int level = kTopOrder, bits = kTopOrder;
    while (level < order) {
      const int shift = order - level;
      const uint32_t mask = (1u << bits) - 1;
      const size_t slot = table + (((at.y >> shift) & mask) << bits) + ((at.x >> shift) & mask);
      SUITE_CHECK(entries_[slot] >= 0);  // a leaf above a leaf
      if (entries_[slot] == 0) {
        entries_[slot] = static_cast<int>(entries_.size());
        entries_.resize(entries_.size() + (size_t{1} << (2 * kStride)), 0);
      }
      table = static_cast<size_t>(entries_[slot]);
      level += kStride, bits = kStride;
    }
    // The leaf fills a square of entries.
    const int grow = level - order;
    const uint32_t mask = (1u << bits) - 1, n = 1u << grow;
    const uint32_t x = (at.x << grow) & mask, y = (at.y << grow) & mask;
    for (uint32_t v = y; v < y + n; ++v)
      for (uint32_t u = x; u < x + n; ++u) {
        int& entry = entries_[table + (static_cast<size_t>(v) << bits) + u];
        SUITE_CHECK(entry == 0);
        entry = leaf;
      }
  }
}

}  // namespace suite::sqt
