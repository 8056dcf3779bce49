#include "transport/truth/terrain.h"

#include <array>
#include <bit>
#include <cmath>

#include "math/sampling.h"
#include "math/warps.h"

namespace suite {

namespace {

Dir side_looked_at(const FirstMeeting& first) {
  const Dir n = first.at->geometric_normal;
  return dot(first.out, n) >= 0 ? n : -n;
}

void add_normal(const TruthContext&, const TruthSample& s, double* sum) {
  if (!s.first) return;
  const Dir n = side_looked_at(*s.first);
  sum[0] += n.x, sum[1] += n.y, sum[2] += n.z;
}

// Eight directions about the normal, with the cosine's density: the share of them that goes up and meets nothing. The
// draw belongs to the place, so that results do not depend on threads.
void add_open_sky(const TruthContext& c, const TruthSample& s, double* sum) {
  constexpr size_t kRays = 8;
  if (!s.first) return;
  const Vec3 at = s.first->at->position;
  const Frame frame = Frame::around(side_looked_at(*s.first));
  const auto bits = [](double x) { return std::bit_cast<uint64_t>(x); };
  Pcg32 random(hash_of(bits(at.x), bits(at.y), bits(at.z)));
  const double off = 1e-3 + 2e-7 * length(at);  // m, off the surface
  std::array<Ray, kRays> rays;
  size_t up = 0;
  for (size_t i = 0; i < kRays; ++i) {
    const double u = (static_cast<double>(i) + random.uniform()) / kRays, v = random.uniform();
    const Dir d = frame.to_world(cosine_hemisphere({u, v}));
    if (!(d.z > 0)) continue;
    Ray& ray = rays[up++];
    ray.origin = at + side_looked_at(*s.first) * off, ray.direction = d, ray.time = s.path.time;
  }
  std::array<uint8_t, kRays> blocked{};
  std::array<double, kRays> far;
  far.fill(INFINITY);
  TraceStatistics unused;
  c.tracer.occluded({rays.data(), up}, {far.data(), up}, {blocked.data(), up}, false, unused);
  for (size_t i = 0; i < up; ++i) sum[0] += (blocked[i] ? 0.0 : 1.0) / kRays;
}

std::unique_ptr<const TruthCollector> one(const TruthContext& c, size_t slots, const char* column,
                                          SimpleCollector::Add add, SimpleCollector::Finish finish) {
  return std::make_unique<SimpleCollector>(c, slots, std::vector<std::string>{column}, add, finish);
}

}  // namespace

void add_terrain_rows(std::vector<TruthRow>& table) {
  table.push_back(
      {"slope", "angle between the mean normal of the first hits and the vertical", "deg", [](const TruthContext& c) {
         return one(c, 3, "slope [deg]", add_normal,
                    [](const TruthContext&, const double* n, const TruthCounts& counts, double* v) {
                      if (counts.hits > 0) v[0] = std::atan2(std::hypot(n[0], n[1]), n[2]) / kDegree;
                    });
       }});
  table.push_back({"aspect", "compass direction in which that slope falls; none where it is level", "deg",
                   [](const TruthContext& c) {
                     return one(c, 3, "aspect [deg]", add_normal,
                                [](const TruthContext&, const double* n, const TruthCounts&, double* v) {
                                  if (std::hypot(n[0], n[1]) > 1e-6 * std::fabs(n[2]))
                                    v[0] = std::fmod(std::atan2(n[0], n[1]) / kDegree + 360, 360);
                                });
                   }});
  table.push_back({"sky_view",
                   "share of an even sky's light that reaches the first hits, 1 on open level ground; by eight rays a "
                   "sample",
                   "", [](const TruthContext& c) {
                     return one(c, 1, "sky view", add_open_sky,
                                [](const TruthContext&, const double* sum, const TruthCounts& n, double* v) {
                                  if (n.hits > 0) v[0] = sum[0] / n.hits;
                                });
                   }});
}

}  // namespace suite
