// Based on: area-proportional choice by the cumulative sum of triangle areas; the square-root map of two uniform
// numbers onto a triangle (Turk, Graphics Gems, 1990).
#include "scene/scatter.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "math/sampling.h"

namespace suite {

std::vector<Affine3> scatter(std::span<const Mesh> meshes, const ScatterRule& rule) {
  struct Place {
    uint32_t mesh, triangle;
  };
  std::vector<Place> places;
  std::vector<double> area;
  const auto corner = [&](Place p, size_t k) {
    const Mesh& m = meshes[p.mesh];
    const float* q = &m.positions[3 * size_t{m.indices[3 * size_t{p.triangle} + k]}];
    return m.origin + Vec3{q[0], q[1], q[2]};
  };
  double total = 0;
  for (uint32_t m = 0; m < meshes.size(); ++m)
    for (uint32_t t = 0; t < meshes[m].triangle_count(); ++t) {
      const Place p{m, t};
      total += 0.5 * length(cross(corner(p, 1) - corner(p, 0), corner(p, 2) - corner(p, 0)));
      places.push_back(p);
      area.push_back(total);
    }
  Pcg32 random(rule.seed);
  const double expected = total * rule.density_per_m2;
  // As matrices here, as placements in the scene, and while a table of them grows.
  constexpr double bytes = 3 * sizeof(Affine3) + 2 * sizeof(Placement);
  if (const double most = std::min(2147483648.0, available_memory() / bytes); !(expected < most))
    throw Error(strf("%.3g scattered placements", expected), strf("lower the density: %.3g can be held here", most));
  const auto count = static_cast<size_t>(std::floor(expected + random.uniform()));
  std::vector<Affine3> out;
  out.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    // Every point draws the same number of random numbers, so that a region only leaves points out.
    const double pick = random.uniform() * total, a = std::sqrt(random.uniform()), b = random.uniform();
    const double heading = random.uniform() * 2 * kPi,
                 scale = rule.scale_low + (rule.scale_high - rule.scale_low) * random.uniform();
    const Place p = places[static_cast<size_t>(
        std::min<std::ptrdiff_t>(std::upper_bound(area.begin(), area.end(), pick) - area.begin(),
                                 static_cast<std::ptrdiff_t>(area.size()) - 1))];
    const Vec3 at = corner(p, 0) * (1 - a) + corner(p, 1) * (a * (1 - b)) + corner(p, 2) * (a * b);
    if (rule.region && !(at.x >= (*rule.region)[0] && at.y >= (*rule.region)[1] && at.x <= (*rule.region)[2] &&
                         at.y <= (*rule.region)[3]))
      continue;
    Affine3 t = scaling({scale, scale, scale});
    if (rule.turn) t = rotation({0, 0, 1}, heading) * t;
    t.b = at;
    out.push_back(t);
  }
  return out;
}

}  // namespace suite
