#include "trace/tile_bvh.h"

#include <algorithm>
#include <numeric>

namespace suite {

void TileBvh::build(std::span<const Box3> boxes) {
  nodes_.clear();
  if (boxes.empty()) return;
  std::vector<uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  nodes_.reserve(2 * boxes.size());
  build(boxes, order, 0);
}

uint32_t TileBvh::build(std::span<const Box3> boxes, std::span<uint32_t> order, int depth) {
  const uint32_t index = static_cast<uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Box3 box, centers;
  for (const uint32_t i : order) box.grow(boxes[i]), centers.grow(boxes[i].center());
  nodes_[index].box = box;
  if (order.size() == 1) {
    nodes_[index].tile = order[0];
    return index;
  }
  // Median split along the widest spread of centres: depth is at most log2 of the number of tiles.
  const Vec3 spread = centers.size();
  const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
  const size_t half = order.size() / 2;
  std::nth_element(order.begin(), order.begin() + static_cast<long>(half), order.end(), [&](uint32_t a, uint32_t b) {
    const double ca = boxes[a].center()[axis], cb = boxes[b].center()[axis];
    return ca < cb || (ca == cb && a < b);
  });
  build(boxes, order.first(half), depth + 1);
  nodes_[index].second = build(boxes, order.subspan(half), depth + 1);
  return index;
}

}  // namespace suite
