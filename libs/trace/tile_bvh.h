// A small bounding-volume hierarchy in double precision over the tiles of a scene.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

// Entry and exit distance of a ray through a box, clipped to [0, t_max]; false when it misses. Slabs are widened by
// 4 ulp (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013) so that rays in a face are not lost. Every ray comes here,
// and a call costs as much as a slab.
[[gnu::always_inline]] inline bool clip(const Box3& box, Vec3 origin, Vec3 inverse_direction, double t_max,
                                        double& enter, double& leave) {
  double near = 0, far = t_max;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.low[i] - origin[i]) * inverse_direction[i],
                 b = (box.high[i] - origin[i]) * inverse_direction[i];
    // 0 * infinity when the origin lies in the slab's plane and the ray runs within it: NaN compares false and the
    // slab does not clip.
    const double first = a > b ? b : a, last = (a > b ? a : b) * (1 + 4 * 2.22e-16);
    if (first > near) near = first;
    if (last < far) far = last;
  }
  enter = near;
  leave = far;
  return near <= far;
}
inline Vec3 inverse_of(Dir d) { return {1 / d.x, 1 / d.y, 1 / d.z}; }

class TileBvh {
 public:
  void build(std::span<const Box3> boxes);
  // A node or a tile that a ray has yet to see.
  struct Entry {
    double enter;
    uint32_t tile, node;
    bool inner() const { return tile == UINT32_MAX; }
    // Of those entered at one place inner nodes come first, which may hold tiles of any number.
    bool before(const Entry& o) const {
      if (enter != o.enter) return enter < o.enter;
      return inner() != o.inner() ? inner() : tile < o.tile;
    }
  };
  // Calls visit(tile, enter) for the tiles on the ray in the order of (enter, tile), until visit has lowered t_max
  // below the rest. Tiles overlap, and so do nodes: depth first would not do. open: room to work in.
  template <class Visit>
  void walk(const Ray& ray, double& t_max, std::vector<Entry>& open, Visit&& visit) const {
    open.clear();  // sorted, the next one last; there are rarely more than ten
    const Vec3 inverse = inverse_of(ray.direction);
    const auto push = [&](uint32_t node) {
      double enter = 0, leave = 0;
      if (!clip(nodes_[node].box, ray.origin, inverse, t_max, enter, leave)) return;
      const Entry e{enter, nodes_[node].tile, node};
      open.push_back(e);
      size_t at = open.size() - 1;
      for (; at > 0 && open[at - 1].before(e); --at) open[at] = open[at - 1];
      open[at] = e;
    };
    if (!nodes_.empty()) push(0);
    while (!open.empty()) {
      const Entry e = open.back();
      open.pop_back();
      if (e.enter > t_max) return;
      if (!e.inner()) {
        visit(e.tile, e.enter);
        continue;
      }
      push(e.node + 1);
      push(nodes_[e.node].second);
    }
  }

 private:
  struct Node {
    Box3 box;
    uint32_t second = 0;         // right child; the left one follows its parent
    uint32_t tile = UINT32_MAX;  // leaves
  };
  uint32_t build(std::span<const Box3> boxes, std::span<uint32_t> order, int depth);
  std::vector<Node> nodes_;
};

}  // namespace suite
