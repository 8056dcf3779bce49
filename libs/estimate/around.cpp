#include "estimate/around.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace suite {

namespace {

constexpr double kAlike = 4;  // joint standard errors
constexpr size_t kHalfPlanes = 8;

// A place in the window, and the half-planes that hold it: 1 or 0.
struct Offset {
  long x, y;
  std::array<double, kHalfPlanes> in;
};

std::vector<Offset> make_window(long reach) {
  constexpr std::array<std::array<long, 2>, kHalfPlanes> normals{
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};
  std::vector<Offset> made;
  for (long y = -reach; y <= reach; ++y)
    for (long x = -reach; x <= reach; ++x) {
      if (x == 0 && y == 0) continue;
      Offset o{x, y, {}};
      const bool beside = std::max(std::labs(x), std::labs(y)) == 1;
      for (size_t h = 0; h < kHalfPlanes; ++h) {
        const long side = normals[h][0] * x + normals[h][1] * y;
        o.in[h] = side > 0 || (side == 0 && beside);
      }
      made.push_back(o);
    }
  return made;
}

const std::vector<Offset>& window(long reach) {
  static const std::vector<Offset> near = make_window(2), far = make_window(4);
  return reach == 2 ? near : far;
}

}  // namespace

double variance_around(const SeenGrid& g, long x, long y, double same, long reach) {
  const Seen& here = g.seen[static_cast<size_t>(y * g.columns + x)];
  std::array<double, kHalfPlanes> sum{}, alike{}, there_are{};
  for (const Offset& o : window(reach)) {
    const long u = x + o.x, v = y + o.y;
    if (u < 0 || v < 0 || u >= g.columns || v >= g.rows) continue;
    const Seen& there = g.seen[static_cast<size_t>(v * g.columns + u)];
    const double apart = std::fabs(there.mean - here.mean) - same;
    const double counts = !(apart > 0) || apart * apart <= kAlike * kAlike * (there.square + here.square);
    const double variance = counts * there.variance;
    for (size_t h = 0; h < kHalfPlanes; ++h) {
      there_are[h] += o.in[h];
      alike[h] += o.in[h] * counts;
      sum[h] += o.in[h] * variance;
    }
  }
  const double most = *std::max_element(there_are.begin(), there_are.end());
  double least = INFINITY;
  for (size_t h = 0; h < kHalfPlanes; ++h)
    if (there_are[h] > 0 && 3 * there_are[h] >= most) least = std::min(least, sum[h] / std::max(alike[h], 1.0));
  return std::isfinite(least) ? least : 0;
}

double variance_nearby(const SeenGrid& g, long x, long y, double same) {
  const double mean = g.seen[static_cast<size_t>(y * g.columns + x)].mean;
  double sum = 0, alike = 0;
  for (const Offset& o : window(4)) {
    const long u = x + o.x, v = y + o.y;
    if (u < 0 || v < 0 || u >= g.columns || v >= g.rows) continue;
    const Seen& there = g.seen[static_cast<size_t>(v * g.columns + u)];
    if (!(std::fabs(there.mean - mean) <= same)) continue;
    sum += there.variance, alike += 1;
  }
  return alike > 0 ? sum / alike : 0;
}

}  // namespace suite
