#include "formats/obj/polygon.h"

#include <cmath>

namespace suite {

namespace {

double area2(Vec2 a, Vec2 b, Vec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

bool inside(Vec2 p, Vec2 a, Vec2 b, Vec2 c) {
  return area2(a, b, p) >= 0 && area2(b, c, p) >= 0 && area2(c, a, p) >= 0;
}
bool same(Vec2 a, Vec2 b) { return a.x == b.x && a.y == b.y; }

}  // namespace

std::vector<std::array<int, 3>> split_polygon(std::span<const Vec3> corners, bool& clean) {
  clean = true;
  const int n = static_cast<int>(corners.size());
  std::vector<std::array<int, 3>> out;
  if (n < 3) return out;
  if (n == 3) return {{0, 1, 2}};
  // Project along the Newell normal, which exists for slightly bent polygons too.
  Vec3 normal;
  for (int i = 0; i < n; ++i) normal += cross(corners[i] - corners[0], corners[(i + 1) % n] - corners[0]);
  std::vector<int> ring(n);
  for (int i = 0; i < n; ++i) ring[i] = i;
  const double len = length(normal);
  std::vector<Vec2> p(n);
  if (len > 0) {
    const Frame frame = Frame::around(normal / len);
    for (int i = 0; i < n; ++i) p[i] = {dot(corners[i] - corners[0], frame.x), dot(corners[i] - corners[0], frame.y)};
  }
  // Cut ears, preferring the one with the best shape so that slivers are avoided where there is a choice.
  while (ring.size() > 3 && len > 0) {
    const size_t m = ring.size();
    size_t best = m;
    double best_quality = 0;
    for (size_t k = 0; k < m; ++k) {
      const Vec2 a = p[ring[(k + m - 1) % m]], b = p[ring[k]], c = p[ring[(k + 1) % m]];
      const double area = area2(a, b, c);
      const double edges = std::pow(std::hypot(b.x - a.x, b.y - a.y), 2) +
                           std::pow(std::hypot(c.x - b.x, c.y - b.y), 2) +
                           std::pow(std::hypot(a.x - c.x, a.y - c.y), 2);
      if (!(area > 1e-14 * edges) || area / edges <= best_quality) continue;
      bool ear = true;
      for (size_t q = 0; q < m && ear; ++q) {
        const Vec2 point = p[ring[q]];
        if (q == k || q == (k + 1) % m || q == (k + m - 1) % m || same(point, a) || same(point, b) || same(point, c))
          continue;
        ear = !inside(point, a, b, c);
      }
      if (ear) best = k, best_quality = area / edges;
    }
    if (best == m) break;
    out.push_back({ring[(best + m - 1) % m], ring[best], ring[(best + 1) % m]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
    if (out.size() > 100000) break;
  }
  if (ring.size() > 3) clean = false;
  for (size_t k = 1; k + 1 < ring.size(); ++k) out.push_back({ring[0], ring[k], ring[k + 1]});
  return out;
}

}  // namespace suite
