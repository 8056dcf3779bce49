#include <algorithm>
#include <atomic>
#include <cmath>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "base/parallel.h"
#include "mesh/decimate.h"

namespace suite {

double farthest(std::span<const Vec3> positions, std::span<const uint32_t> from, std::span<const uint32_t> to) {
  using Plain = CGAL::Simple_cartesian<double>;  // distances need no exact predicates
  using Triangles = std::vector<Plain::Triangle_3>;
  using Item = CGAL::AABB_triangle_primitive<Plain, Triangles::const_iterator>;
  const auto point = [](const Vec3& p) { return Plain::Point_3(p.x, p.y, p.z); };
  Triangles triangles;
  for (size_t c = 0; c + 2 < to.size(); c += 3)
    triangles.emplace_back(point(positions[to[c]]), point(positions[to[c + 1]]), point(positions[to[c + 2]]));
  CGAL::AABB_tree<CGAL::AABB_traits<Plain, Item>> tree(triangles.cbegin(), triangles.cend());
  tree.accelerate_distance_queries();
  std::vector<double> farthest_of(from.size() / 3, 0.0);
  parallel_for(0, farthest_of.size(), 256, [&](size_t begin, size_t end) {
    for (size_t t = begin; t < end; ++t) {
      const Vec3 a = positions[from[3 * t]], b = positions[from[3 * t + 1]], c = positions[from[3 * t + 2]];
      for (const Vec3& p : {a, b, c, (a + b) / 2, (b + c) / 2, (c + a) / 2, (a + b + c) / 3})
        farthest_of[t] = std::max(farthest_of[t], tree.squared_distance(point(p)));
    }
  });
  return farthest_of.empty() ? 0 : std::sqrt(*std::max_element(farthest_of.begin(), farthest_of.end()));
}

}  // namespace suite
