#include <cmath>

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

}  // namespace

DraftPlacement Reader::read_placement(const Params& p) {
  DraftPlacement made;
  made.where = p.where();
  made.target = reference(p.at("place"));
  if (const auto v = p.find("material")) made.material = reference(*v);
  if (const auto v = p.find("tag")) made.tag = reference(*v);
  if (const auto v = p.find("on")) made.on = reference(*v);
  if (const auto m = p.find("matrix")) {
    for (const char* other : {"translate", "rotate", "scale"})
      if (p.has(other)) throw p.error(strf("'matrix' and '%s' cannot be combined", other));
    made.to_parent = read_matrix(*m);
    return made;
  }
  if (const auto s = p.find("scale")) {
    if (s->kind() == Params::Kind::list) {
      const auto v = s->as_vec3();
      made.to_parent = scaling({v[0], v[1], v[2]});
    } else {
      const double v = s->as_number();
      made.to_parent = scaling({v, v, v});
    }
  }
  if (const auto r = p.find("rotate"))
    for (const Params& step : r->items()) made.to_parent = read_rotation(step) * made.to_parent;
  if (const auto t = p.find("translate")) {
    const auto v = t->as_vec3();
    made.to_parent = translation({v[0], v[1], v[2]}) * made.to_parent;
  }
  return made;
}

void Reader::read_group(const std::string& name, const Params& p) {
  // Filed even when a placement is wrong, so that names still resolve.
  const size_t slot = draft_.groups.size();
  draft_.groups.push_back({name, p.where(), {}});
  for (const Params& row : p.items())
    item("SP001", row, [&] { draft_.groups[slot].placements.push_back(read_placement(row)); });
}

}  // namespace suite::scene_text
