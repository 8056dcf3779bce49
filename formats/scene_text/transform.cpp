#include "formats/scene_text/transform.h"

#include <cmath>

#include "math/dualquat.h"

namespace suite {

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

std::optional<Affine3> find_transform(const Params& p) {
  const auto matrix = p.find("matrix"), scale = p.find("scale"), rotate = p.find("rotate"),
             translate = p.find("translate");
  if (matrix) {
    for (const char* other : {"translate", "rotate", "scale"})
      if (p.has(other)) throw p.error(strf("'matrix' and '%s' cannot be combined", other));
    return read_matrix(*matrix);
  }
  if (!scale && !rotate && !translate) return std::nullopt;
  Affine3 made;
  if (scale) {
    if (scale->kind() == Params::Kind::list) {
      const auto v = scale->as_vec3();
      made = scaling({v[0], v[1], v[2]});
    } else {
      const double v = scale->as_number();
      made = scaling({v, v, v});
    }
  }
  if (rotate)
    for (const Params& step : rotate->items()) made = read_rotation(step) * made;
  if (translate) {
    const auto v = translate->as_vec3();
    made = translation({v[0], v[1], v[2]}) * made;
  }
  return made;
}

}  // namespace suite
