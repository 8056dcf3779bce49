// A small bounding-volume hierarchy in double precision over the tiles of a scene.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

// Entry and exit distance of a ray through a box, clipped to [0, t_max]; false when it misses. Slabs are widened by
// 4 ulp (Ize, "Robust BVH ray traversal", JCGT 2(2), 2013) so that rays in a face are not lost.
inline bool clip(const Box3& box, Vec3 origin, Vec3 inverse_direction, double t_max, double& enter, double& leave) {
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
  // Calls visit(tile, enter) for the tiles on the ray, nearest box first, until visit has lowered t_max below the rest.
  template <class Visit>
  void walk(const Ray& ray, double& t_max, Visit&& visit) const {
    struct Entry {
      uint32_t node;
      double enter;
    };
    Entry stack[64];
    int top = 0;
    double enter = 0, leave = 0;
    const Vec3 inverse = inverse_of(ray.direction);
    if (nodes_.empty() || !clip(nodes_[0].box, ray.origin, inverse, t_max, enter, leave)) return;
    stack[top++] = {0, enter};
    while (top) {
      const Entry e = stack[--top];
      if (e.enter > t_max) continue;
      const Node& n = nodes_[e.node];
      if (n.tile != UINT32_MAX) {
        visit(n.tile, e.enter);
        continue;
      }
      double enter_a = 0, enter_b = 0;
      const bool a = clip(nodes_[e.node + 1].box, ray.origin, inverse, t_max, enter_a, leave);
      const bool b = clip(nodes_[n.second].box, ray.origin, inverse, t_max, enter_b, leave);
      const Entry ea{e.node + 1, enter_a}, eb{n.second, enter_b};
      if (a && b) {
        stack[top++] = enter_a <= enter_b ? eb : ea;
        stack[top++] = enter_a <= enter_b ? ea : eb;
      } else if (a) {
        stack[top++] = ea;
      } else if (b) {
        stack[top++] = eb;
      }
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
