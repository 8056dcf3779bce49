// An independent ray tracer for tests, in double precision throughout: triangles in a plain hierarchy of boxes, met by
// the usual determinants (Moeller & Trumbore 1997). It shares nothing with the renderer's tracer but the vertices, and
// needs no offsets: a ray that leaves a triangle is told not to meet that same one again.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace suite::test {

class DoubleTracer {
 public:
  struct Triangle {
    Vec3 a, b, c;
    uint32_t id = 0;
  };
  static constexpr uint32_t kNothing = 0xffffffffu;
  struct Met {
    uint32_t triangle = kNothing;  // in the order given
    double distance = INFINITY;    // m
  };

  explicit DoubleTracer(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
    order_.resize(triangles_.size());
    for (uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    nodes_.reserve(2 * order_.size());
    if (!order_.empty()) build(0, static_cast<uint32_t>(order_.size()));
    in_order_.reserve(order_.size());
    for (const uint32_t i : order_) in_order_.push_back(triangles_[i]);  // a leaf's lie side by side
  }
  const Triangle& triangle(uint32_t i) const { return triangles_[i]; }
  size_t size() const { return triangles_.size(); }

  // The first triangle but `except` on the ray within `reach`; with `any` some triangle, not the first.
  Met meet(Vec3 origin, Dir direction, uint32_t except, double reach = INFINITY, bool any = false) const {
    Met met;
    met.distance = reach;
    // Never infinite: a direction within a face's plane that begins in it must not give 0 times infinity.
    const auto invert = [](double d) { return 1 / (std::abs(d) < 1e-200 ? std::copysign(1e-200, d) : d); };
    const Vec3 inverse{invert(direction.x), invert(direction.y), invert(direction.z)};
    Entry stack[128];
    uint32_t top = 0;
    if (!nodes_.empty()) stack[top++] = {0, entry(nodes_[0].box, origin, inverse)};
    while (top) {
      const Entry entered = stack[--top];
      if (entered.distance > met.distance * (1 + 1e-14) + 1e-300) continue;
      const Node& node = nodes_[entered.node];
      if (!node.count) {
        // The nearer child is looked into first: what it holds often rules the other out.
        Entry near{node.first, entry(nodes_[node.first].box, origin, inverse)};
        Entry far{node.second, entry(nodes_[node.second].box, origin, inverse)};
        if (far.distance < near.distance) std::swap(near, far);
        if (far.distance < INFINITY) stack[top++] = far;
        if (near.distance < INFINITY) stack[top++] = near;
        continue;
      }
      for (uint32_t k = node.first; k < node.first + node.count; ++k) {
        const uint32_t i = order_[k];
        double t;
        if (i == except || !hits(in_order_[k], origin, direction, t) || t >= met.distance) continue;
        met.distance = t;
        met.triangle = i;
        if (any) return met;
      }
    }
    return met;
  }

 private:
  struct Node {
    Box3 box;
    uint32_t first = 0, second = 0, count = 0;  // children, or a range of order_
  };

  struct Entry {
    uint32_t node;
    double distance;  // to the box, m
  };

  // The way to the box, infinite if the ray misses it.
  static double entry(const Box3& box, Vec3 origin, Vec3 inverse) {
    const Vec3 a = box.low - origin, b = box.high - origin;
    const double x1 = a.x * inverse.x, x2 = b.x * inverse.x, y1 = a.y * inverse.y, y2 = b.y * inverse.y,
                 z1 = a.z * inverse.z, z2 = b.z * inverse.z;
    const double near = std::max(std::max(std::min(x1, x2), std::min(y1, y2)), std::max(std::min(z1, z2), 0.0));
    const double far = std::min(std::min(std::max(x1, x2), std::max(y1, y2)), std::max(z1, z2));
    return near <= far * (1 + 1e-14) + 1e-300 ? near : INFINITY;
  }

  static bool hits(const Triangle& q, Vec3 origin, Dir direction, double& t) {
    const Vec3 e1 = q.b - q.a, e2 = q.c - q.a, p = cross(direction, e2), s = origin - q.a;
    const double determinant = dot(e1, p);
    if (determinant == 0) return false;
    const double u = dot(s, p) / determinant;
    if (!(u >= 0 && u <= 1)) return false;
    const Vec3 r = cross(s, e1);
    const double v = dot(direction, r) / determinant;
    if (!(v >= 0 && u + v <= 1)) return false;
    t = dot(e2, r) / determinant;
    return t > 0;
  }

  uint32_t build(uint32_t begin, uint32_t end) {
    const auto number = static_cast<uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Box3 box, centres;
    for (uint32_t k = begin; k < end; ++k) {
      const Triangle& q = triangles_[order_[k]];
      box.grow(q.a), box.grow(q.b), box.grow(q.c);
      centres.grow(centre(q));
    }
    nodes_[number].box = box;
    if (end - begin <= 4) {
      nodes_[number].first = begin, nodes_[number].count = end - begin;
      return number;
    }
    const Vec3 size = centres.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t middle = (begin + end) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](uint32_t i, uint32_t j) { return centre(triangles_[i])[axis] < centre(triangles_[j])[axis]; });
    const uint32_t first = build(begin, middle), second = build(middle, end);
    nodes_[number].first = first, nodes_[number].second = second;
    return number;
  }
  static Vec3 centre(const Triangle& q) { return (q.a + q.b + q.c) / 3.0; }

  std::vector<Triangle> triangles_, in_order_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace suite::test
