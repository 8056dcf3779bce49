#include <cmath>

#include "formats/instances/instances.h"
#include "formats/scene_text/reader.h"
#include "math/dualquat.h"

namespace suite::scene_text {

namespace {

Affine3 read_rotation(const Params& p) {
  if (const auto q = p.find("quaternion")) {
    const std::vector<double> v = q->as_numbers();
    if (v.size() != 4 || !(std::hypot(std::hypot(v[0], v[1]), std::hypot(v[2], v[3])) > 1e-12))
      throw q->error("a quaternion is four numbers (w, x, y, z), not all 0");
    return Pose{normalized(Quat{v[0], v[1], v[2], v[3]}), {}}.affine();
  }
  if (const auto axis = p.find("axis")) {
    const auto a = axis->as_vec3();
    const Vec3 k{a[0], a[1], a[2]};
    if (!(length(k) > 1e-12)) throw axis->error("the axis has no length");
    return rotation(normalized(k), p.number("angle_deg") * kDegree);
  }
  if (const auto euler = p.find("euler_deg")) {
    const auto angle = euler->as_vec3();
    const std::string order = p.text("order", "xyz");
    if (order.size() != 3 || order.find_first_not_of("xyz") != std::string::npos)
      throw p.at("order").error("an order is three of x, y, z", "'xyz' turns about x first");
    Affine3 r;
    for (int i = 0; i < 3; ++i) {
      Vec3 axis;
      axis[order[i] - 'x'] = 1;
      r = rotation(axis, angle[i] * kDegree) * r;
    }
    return r;
  }
  if (const auto heading = p.find("heading_deg")) {
    // Compass: what faced north faces the heading.
    return rotation({0, 0, 1}, azimuth_from_compass_deg(heading->as_number()) - azimuth_from_compass_deg(0));
  }
  throw p.error("a rotation needs 'euler_deg', 'axis', 'quaternion' or 'heading_deg'");
}

Affine3 read_matrix(const Params& p) {
  const std::vector<double> m = p.as_numbers();
  if (m.size() != 12 && m.size() != 16)
    throw p.error(strf("a matrix is 12 or 16 numbers, row by row, found %zu", m.size()));
  if (m.size() == 16 && (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1))
    throw p.error("the last row of a matrix must be 0 0 0 1");
  return {{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}, {m[3], m[7], m[11]}};
}

ScatterRule read_scatter(const Params& p) {
  ScatterRule rule;
  rule.density_per_m2 = p.number_in("density_per_m2", 1e-12, 1e6, "1/m2");
  rule.seed = static_cast<uint64_t>(p.integer("seed", 0, 1LL << 53, 1));
  rule.turn = p.boolean("turn", true);
  if (const auto scale = p.find("scale")) {
    const std::vector<double> range = scale->as_numbers();
    if (range.size() != 2 || !(range[0] > 0 && range[0] <= range[1]))
      throw scale->error("the scale of a scatter is [low, high], above 0");
    rule.scale_low = range[0], rule.scale_high = range[1];
  }
  if (const auto region = p.find("region")) {
    const std::vector<double> r = region->as_numbers();
    if (r.size() != 4 || !(r[0] < r[2] && r[1] < r[3]))
      throw region->error("a region is [x0, y0, x1, y1], low corner first");
    rule.region = {r[0], r[1], r[2], r[3]};
  }
  return rule;
}

}  // namespace

DraftPlacement Reader::read_placement(const Params& p) {
  DraftPlacement made;
  made.where = p.where();
  made.target = reference(p.at("place"));
  if (const auto v = p.find("material")) made.material = reference(*v);
  if (const auto v = p.find("tag")) made.tag = reference(*v);
  if (const auto v = p.find("on")) made.on = reference(*v);
  if (const auto v = p.find("table")) {
    made.table = true;
    made.rows = read_instances(input(*v));
  }
  if (const auto v = p.find("scatter")) {
    if (made.table) throw v->error("'table' and 'scatter' cannot be combined");
    if (!made.on.given()) throw v->error("'scatter' needs 'on', the terrain or mesh to scatter over");
    made.scatter = read_scatter(*v);
  }
  made.to_parent = read_transform(p);
  return made;
}

// `matrix`, or scale, then rotate, then translate.
Affine3 Reader::read_transform(const Params& p) {
  Affine3 to_parent;
  if (const auto m = p.find("matrix")) {
    for (const char* other : {"translate", "rotate", "scale"})
      if (p.has(other)) throw p.error(strf("'matrix' and '%s' cannot be combined", other));
    return read_matrix(*m);
  }
  if (const auto s = p.find("scale")) {
    if (s->kind() == Params::Kind::list) {
      const auto v = s->as_vec3();
      to_parent = scaling({v[0], v[1], v[2]});
    } else {
      const double v = s->as_number();
      to_parent = scaling({v, v, v});
    }
  }
  if (const auto r = p.find("rotate"))
    for (const Params& step : r->items()) to_parent = read_rotation(step) * to_parent;
  if (const auto t = p.find("translate")) {
    const auto v = t->as_vec3();
    to_parent = translation({v[0], v[1], v[2]}) * to_parent;
  }
  return to_parent;
}

void Reader::read_group(const std::string& name, const Params& p) {
  // Filed even when a placement is wrong, so that names still resolve.
  const size_t slot = draft_.groups.size();
  draft_.groups.push_back({name, p.where(), {}});
  for (const Params& row : p.items())
    item("SP001", row, [&] { draft_.groups[slot].placements.push_back(read_placement(row)); });
}

}  // namespace suite::scene_text
