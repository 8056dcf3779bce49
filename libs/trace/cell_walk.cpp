#include "trace/cell_walk.h"

#include <algorithm>
#include <cmath>

namespace suite {

namespace {
// A ray that has crossed this many cells without meeting anything runs level for ever.
constexpr uint32_t kMaxCells = 100000;
}  // namespace

double CellWalk::to_side(const Ray& ray) const {
  double t = INFINITY;
  const double low[2] = {cell_.low.x, cell_.low.y}, size[2] = {cell_.size.x, cell_.size.y};
  for (int a = 0; a < 2; ++a) {
    const double d = ray.direction[a];
    if (d != 0) t = std::min(t, ((d > 0 ? low[a] + size[a] : low[a]) - ray.origin[a]) / d);
  }
  return std::max(t, 0.0);
}

// Into the cell; a ray exactly on a side belongs to the cell it runs into.
void CellWalk::wrap(Ray& ray) const {
  const double low[2] = {cell_.low.x, cell_.low.y}, size[2] = {cell_.size.x, cell_.size.y};
  for (int a = 0; a < 2; ++a) {
    const double share = (ray.origin[a] - low[a]) / size[a];
    double shift = std::floor(share);
    if (ray.direction[a] < 0 && share == shift) shift -= 1;
    ray.origin[a] -= shift * size[a];
  }
}

void CellWalk::start(const Periodic& periodic, const Box3& bounds, std::span<const Ray> rays,
                     std::span<const double> distance) {
  cell_ = periodic;
  rays_.clear();
  state_.clear();
  if (bounds.empty()) return;
  const double margin = 1e-6 * (1 + bounds.high.z - bounds.low.z);
  low_ = bounds.low.z - margin;
  high_ = bounds.high.z + margin;
  for (size_t i = 0; i < rays.size(); ++i) {
    Ray ray = rays[i];
    double skip = 0;
    if (ray.origin.z > high_ && ray.direction.z < 0) skip = (high_ - ray.origin.z) / ray.direction.z;
    if (ray.origin.z < low_ && ray.direction.z > 0) skip = (low_ - ray.origin.z) / ray.direction.z;
    const double left = (distance.empty() ? INFINITY : distance[i]) - skip;
    if (skip == 0 && (ray.origin.z > high_ || ray.origin.z < low_)) continue;
    if (!(left > 0)) continue;
    ray.origin += ray.direction * skip;
    wrap(ray);
    rays_.push_back(ray);
    state_.push_back({i, skip, left, to_side(ray), 0});
  }
}

bool CellWalk::next(std::vector<double>& reach) const {
  reach.resize(rays_.size());
  // A little beyond the side, so that a surface met exactly there is not lost to the rounding of distances.
  for (size_t i = 0; i < rays_.size(); ++i) reach[i] = std::min(state_[i].side * (1 + 5e-7) + 1e-9, state_[i].left);
  return !rays_.empty();
}

void CellWalk::advance() {
  size_t kept = 0;
  for (size_t i = 0; i < rays_.size(); ++i) {
    State s = state_[i];
    Ray ray = rays_[i];
    if (!(s.left > s.side) || !std::isfinite(s.side) || ++s.cells > kMaxCells) continue;
    ray.origin += ray.direction * s.side;
    s.travelled += s.side;
    s.left -= s.side;
    if ((ray.origin.z > high_ && ray.direction.z >= 0) || (ray.origin.z < low_ && ray.direction.z <= 0)) continue;
    // The side itself was computed with rounding: put the ray exactly on it, then on the opposite one.
    const double low[2] = {cell_.low.x, cell_.low.y}, size[2] = {cell_.size.x, cell_.size.y};
    for (int a = 0; a < 2; ++a) {
      const double d = ray.direction[a], slack = 1e-12 * (std::fabs(low[a]) + size[a]);
      if (d > 0 && ray.origin[a] >= low[a] + size[a] - slack)
        ray.origin[a] = low[a];
      else if (d < 0 && ray.origin[a] <= low[a] + slack)
        ray.origin[a] = low[a] + size[a];
    }
    s.side = to_side(ray);
    rays_[kept] = ray;
    state_[kept++] = s;
  }
  rays_.resize(kept);
  state_.resize(kept);
}

}  // namespace suite
