// Points of elements.
#include <algorithm>
#include <cmath>

#include "heat/elements.h"
#include "heat/strata.h"

namespace suite {

namespace {

constexpr uint32_t kAttempts = 4096;  // to find a point of a material, or past a stretch

// What an area grows by under a transform.
double stretch_along(const Affine3& m, Vec3 unit_normal) { return length(m.normal(unit_normal)); }

// No stretch is larger.
double most_stretch(const Affine3& m) {
  const Vec3 x{m.a[0], m.a[3], m.a[6]}, y{m.a[1], m.a[4], m.a[7]}, z{m.a[2], m.a[5], m.a[8]};
  return std::sqrt(dot(cross(x, y), cross(x, y)) + dot(cross(y, z), cross(y, z)) + dot(cross(z, x), cross(z, x)));
}

bool keeps_shape(const Affine3& m) {
  const double a = stretch_along(m, {1, 0, 0}), b = stretch_along(m, {0, 1, 0}), c = stretch_along(m, {0, 0, 1});
  const double d = stretch_along(m, normalized(Vec3{1, 1, 1}));
  return std::max({a, b, c, d}) < (1 + 1e-9) * std::min({a, b, c, d});
}

}  // namespace

Elements::Local Elements::local_point(const Group& group, uint32_t cell, const std::array<double, 4>& u) const {
  const uint32_t inside = cell - group.first_cell;
  Local at;
  if (group.mesh) {
    const MeshCells::Point p = group.mesh->point(inside, u[0], u[1], u[2]);
    at.triangle = p.triangle, at.u = p.u, at.v = p.v;
    return at;
  }
  const Grid& grid = grids_[group.grid];
  const Grid::Cell& c = grid.cells[inside];
  const PrimitiveFaces::Point p =
      grid.faces.point(c.face, c.low.x + u[0] * (c.high.x - c.low.x), c.low.y + u[1] * (c.high.y - c.low.y));
  at.position = p.position, at.normal = p.normal, at.uv = p.uv, at.stretch = p.stretch / grid.faces.most_stretch();
  return at;
}

// What keeps all of its points is cut into parts; of meshes of many triangles these are parts of their order, which is
// one of neighbours.
void Elements::stratify(const Group& group, uint32_t cell, const PointDraw& draw, std::array<double, 4>& u) const {
  static constexpr uint8_t kInside[] = {1, 2}, kFew[] = {0, 1, 2}, kSome[] = {0, 0, 1}, kMany[] = {0}, kGrid[] = {0, 1};
  std::span<const uint8_t> by = kGrid;
  if (group.mesh) {
    const size_t n = group.mesh->triangles(cell - group.first_cell);
    by = kMany;
    if (n < 8) by = kSome;
    if (n < 4) by = kFew;
    if (n == 1) by = kInside;
  } else if (group.slots > 1 || grids_[group.grid].faces.most_stretch() != 1 ||
             !keeps_shape(slots_[group.first_slot].to_world)) {
    return;
  }
  put_in_stratum(u, by, draw.stratum, draw.strata);
}

// Points whose surroundings are stretched more are kept more often.
Hit Elements::cell_point(uint32_t cell, const PointDraw& draw, uint32_t& attempt) const {
  const Group& group = groups_[group_of_cell_[cell]];
  for (;; ++attempt) {
    std::array<double, 4> u = draw.stream.draw(draw.sample, draw.first_block + attempt);
    if (draw.strata > 1) stratify(group, cell, draw, u);
    uint32_t slot = group.first_slot;
    if (group.slots > 1) {
      const double x = draw.stream.hashed(draw.sample, draw.first_block + attempt) * group.until.back();
      slot += static_cast<uint32_t>(
          std::min<std::ptrdiff_t>(std::upper_bound(group.until.begin(), group.until.end(), x) - group.until.begin(),
                                   static_cast<std::ptrdiff_t>(group.slots) - 1));
    }
    const Slot& s = slots_[slot];
    const Local p = local_point(group, cell, u);
    const bool last = attempt + 1 >= kAttempts;
    if (group.mesh) return tracer_.on_triangle(s.object, p.triangle, p.u, p.v, time_of(s, draw.interval));
    const double kept = p.stretch * stretch_along(s.to_world, p.normal) / most_stretch(s.to_world);
    if (last || (p.stretch == 1 && keeps_shape(s.to_world)) || u[3] < kept)
      return tracer_.on_exact(s.object, p.position, p.normal, p.uv, time_of(s, draw.interval));
  }
}

Hit Elements::point(size_t element, const PointDraw& draw) const {
  const HeatElement& e = elements_[element];
  PointDraw of_element = draw;
  if (e.share != 1) of_element.strata = 1;
  for (uint32_t attempt = 0;; ++attempt) {
    const Hit hit = cell_point(e.cell, of_element, attempt);
    if (e.share == 1 || attempt + 1 >= kAttempts || lookup_.at(tracer_.object(hit.object), hit) == e.material)
      return hit;
  }
}

}  // namespace suite
