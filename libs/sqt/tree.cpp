#include "sqt/tree.h"

#include "base/error.h"

namespace suite::sqt {

Tree::Tree(std::span<const CellId> leaves) : cells_(leaves.begin(), leaves.end()) {
  for (size_t i = 0; i < cells_.size(); ++i) {
    const int order = cells_[i].order();
    const CellXY at = xy_of(cells_[i]);
    size_t node = static_cast<size_t>(at.face);
    for (int bit = order - 1; bit >= 0; --bit) {
      SUITE_CHECK(nodes_[node] >= 0);  // a leaf above a leaf
      if (nodes_[node] == 0) {
        nodes_[node] = static_cast<int>(nodes_.size());
        nodes_.resize(nodes_.size() + 4, 0);
      }
      node = static_cast<size_t>(nodes_[node]) + (((at.y >> bit) & 1) * 2 + ((at.x >> bit) & 1));
    }
    SUITE_CHECK(nodes_[node] == 0);
    nodes_[node] = -static_cast<int>(i) - 1;
  }
  for (size_t t = 0; t < top_.size(); ++t) {
    const uint32_t x = t & ((1u << kTopOrder) - 1), y = (t >> kTopOrder) & ((1u << kTopOrder) - 1);
    int node = nodes_[t >> (2 * kTopOrder)];
    for (int bit = kTopOrder - 1; bit >= 0 && node > 0; --bit)
      node = nodes_[static_cast<size_t>(node) + (((y >> bit) & 1) * 2 + ((x >> bit) & 1))];
    top_[t] = node;
  }
}

}  // namespace suite::sqt
