#include <algorithm>
#include <array>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include "mesh/check.h"

namespace suite {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, uint32_t>;

class Soup {
 public:
  Soup(std::span<const Vec3> positions, std::span<const uint32_t> corners) : positions_(positions), corners_(corners) {}

  uint32_t id(uint32_t t, int k) const { return corners_[3 * size_t{t} + static_cast<size_t>(k)]; }
  Point point(uint32_t v) const { return {positions_[v].x, positions_[v].y, positions_[v].z}; }
  Point corner(uint32_t t, int k) const { return point(id(t, k % 3)); }
  Kernel::Triangle_3 triangle(uint32_t t) const { return {corner(t, 0), corner(t, 1), corner(t, 2)}; }
  bool degenerate(uint32_t t) const {
    return id(t, 0) == id(t, 1) || id(t, 1) == id(t, 2) || id(t, 2) == id(t, 0) ||
           CGAL::collinear(corner(t, 0), corner(t, 1), corner(t, 2));
  }

  // Do two triangles meet in more than the corners and edges they share?
  bool cross(uint32_t a, uint32_t b) const {
    int shared = 0, in_a[3] = {}, in_b[3] = {};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (id(a, i) == id(b, j) && shared < 3) in_a[shared] = i, in_b[shared] = j, ++shared;
    if (shared == 3) return false;  // duplicates have their own code
    if (shared == 2) {
      // Folded onto each other: coplanar, and the third corners on one side of the shared edge.
      const int ka = 3 - in_a[0] - in_a[1], kb = 3 - in_b[0] - in_b[1];
      const Point p = corner(a, in_a[0]), q = corner(a, in_a[1]), r = corner(a, ka), s = corner(b, kb);
      return CGAL::coplanar(p, q, r, s) && CGAL::coplanar_orientation(p, q, r, s) == CGAL::POSITIVE;
    }
    if (shared == 1)
      return CGAL::do_intersect(triangle(a), Kernel::Segment_3(corner(b, in_b[0] + 1), corner(b, in_b[0] + 2))) ||
             CGAL::do_intersect(triangle(b), Kernel::Segment_3(corner(a, in_a[0] + 1), corner(a, in_a[0] + 2)));
    return CGAL::do_intersect(triangle(a), triangle(b));
  }

 private:
  std::span<const Vec3> positions_;
  std::span<const uint32_t> corners_;
};

}  // namespace

namespace {

// Of triangles on the same three places only the first is looked at: the others have their own code.
std::vector<bool> repetitions(std::span<const uint32_t> corners) {
  std::vector<std::array<uint32_t, 4>> keys;
  for (uint32_t t = 0; t < corners.size() / 3; ++t) {
    std::array<uint32_t, 4> k{corners[3 * size_t{t}], corners[3 * size_t{t} + 1], corners[3 * size_t{t} + 2], t};
    std::sort(k.begin(), k.begin() + 3);
    keys.push_back(k);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<bool> repeats(keys.size());
  for (size_t i = 1; i < keys.size(); ++i)
    repeats[keys[i][3]] = std::equal(keys[i].begin(), keys[i].begin() + 3, keys[i - 1].begin());
  return repeats;
}

struct GivenUp {};

}  // namespace

std::optional<std::vector<uint32_t>> self_intersecting(std::span<const Vec3> positions,
                                                       std::span<const uint32_t> corners) {
  const Soup soup(positions, corners);
  const std::vector<bool> repeats = repetitions(corners);
  std::vector<Box> boxes;
  boxes.reserve(corners.size() / 3);
  for (uint32_t t = 0; t < corners.size() / 3; ++t) {
    if (repeats[t] || soup.degenerate(t)) continue;
    double low[3], high[3];
    for (int k = 0; k < 3; ++k) {
      const double x[3] = {positions[soup.id(t, 0)][k], positions[soup.id(t, 1)][k], positions[soup.id(t, 2)][k]};
      low[k] = std::min({x[0], x[1], x[2]});
      high[k] = std::max({x[0], x[1], x[2]});
    }
    boxes.emplace_back(low, high, t);
  }
  std::vector<uint32_t> found;
  size_t left = most_pairs(boxes.size());
  try {
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
      if (left-- == 0) throw GivenUp{};
      if (soup.cross(a.info(), b.info())) found.push_back(a.info()), found.push_back(b.info());
    });
  } catch (const GivenUp&) {
    return std::nullopt;  // which pairs came first is chance, so nothing is said of them
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace suite
