// The surfaces that a place lies on.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "trace/tracer.h"

namespace suite {

// At least what rays start off any surface near the place.
double Tracer::longest_step(Vec3 p) const {
  constexpr double kTile = 8000, kAside = 1e-4;  // m: tiles are smaller; what moves is seen this much aside at most
  const double extent = bounds_.empty() ? 0 : std::min(length(bounds_.high - bounds_.low), kTile);
  return 8 * FLT_EPSILON * extent + 64 * DBL_EPSILON * (std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z)) + 1e-9 +
         (window() ? kAside : 0);
}

void Tracer::touching(const Ray& at, std::vector<Hit>& hits, TraceStatistics& statistics) const {
  constexpr double kShareOfStep = 0.25;  // some roundings
  constexpr double kFlattest = 0.5;      // every surface is steeper to one of the axes
  const double reach = longest_step(at.origin);
  hits.clear();
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    for (double from = -reach; from < reach;) {
      const Ray probe{at.origin + axis * from, axis, at.time, at.draw};
      double left = reach - from;
      Hit hit;
      if (periodic())
        nearest({&probe, 1}, {&hit, 1}, false, statistics);
      else
        nearest_in_tiles({&probe, 1}, {&left, 1}, {&hit, 1}, false, statistics);
      if (!hit.hit()) break;
      from += hit.distance;
      const double slope = dot(axis, hit.normal), step = double{hit.step};
      hit.distance = -from * slope;
      const auto same = [&](const Hit& h) { return h.object == hit.object && dot(h.normal, hit.normal) > 1 - 1e-9; };
      if (std::fabs(hit.distance) <= kShareOfStep * step && std::none_of(hits.begin(), hits.end(), same))
        hits.push_back(hit);
      from += step / std::max(std::fabs(slope), kFlattest);
    }
  }
}

}  // namespace suite
