// Based on: cones towards spheres, Pharr, Jakob & Humphreys, "Physically based rendering", 4th ed. 2023, section 6.2.4;
// the square-root warp of triangles, G. Turk, "Generating random points in triangles", Graphics Gems, 1990.
#include "light/kinds/lamp_shapes.h"

#include <algorithm>
#include <cmath>

#include "math/warps.h"

namespace suite {

namespace {

LampShape flat(LampShape::Kind kind, Vec3 origin, Vec3 a, Vec3 b, bool mirrored) {
  LampShape s;
  s.kind = kind;
  s.origin = origin, s.a = a, s.b = b;
  // A mirrored placement turns the winding round; the front side stays the front side.
  const Vec3 n = cross(a, b) * (mirrored ? -1.0 : 1.0);
  const double twice = length(n);
  s.area = twice * (kind == LampShape::Kind::disk ? kPi : kind == LampShape::Kind::triangle ? 0.5 : 1);
  if (twice > 0) s.normal = n / twice;
  return s;
}

// 1 - cos of half the cone that a sphere fills, seen from outside; 0 inside, and on it within rounding: a point on a
// sphere sees all of its inner side, and points of equal area are drawn as cosines there.
double cone_drop(const LampShape& s, Vec3 from) {
  constexpr double kOn = 1e-6;  // of the radius
  const Vec3 to = s.origin - from;
  const double sin2 = s.a.x * s.a.x / dot(to, to);
  return sin2 < 1 - 2 * kOn ? sin2 / (1 + std::sqrt(1 - sin2)) : 0;
}

}  // namespace

std::optional<LampShape> shape_of(const Primitive& primitive, const Affine3& m) {
  const std::vector<double>& q = primitive.parameters;
  const bool mirrored = m.determinant() < 0;
  if (primitive.kind == PrimitiveKind::plane && q[0] > 0)
    return flat(LampShape::Kind::parallelogram, m.point({-q[0] / 2, -q[1] / 2, 0}), m.vector({q[0], 0, 0}),
                m.vector({0, q[1], 0}), mirrored);
  if (primitive.kind == PrimitiveKind::disk && q[1] == 0)
    return flat(LampShape::Kind::disk, m.point({}), m.vector({q[0], 0, 0}), m.vector({0, q[0], 0}), mirrored);
  if (primitive.kind != PrimitiveKind::sphere) return std::nullopt;
  // Only spheres scaled equally along all axes: an ellipsoid is met by chance.
  const Vec3 x = m.vector({1, 0, 0}), y = m.vector({0, 1, 0}), z = m.vector({0, 0, 1});
  const double scale = length(x), slack = 1e-9 * scale * scale;
  const double worst = std::max({std::fabs(dot(y, y) - dot(x, x)), std::fabs(dot(z, z) - dot(x, x)),
                                 std::fabs(dot(x, y)), std::fabs(dot(y, z)), std::fabs(dot(z, x))});
  if (worst > slack) return std::nullopt;
  LampShape s;
  s.kind = LampShape::Kind::sphere;
  s.origin = m.point({});
  s.a = {q[0] * scale, 0, 0};
  s.area = 4 * kPi * s.a.x * s.a.x;
  return s;
}

std::optional<LampShape> shape_of(const Mesh& mesh, uint32_t triangle, const Affine3& m) {
  Vec3 v[3];
  for (size_t k = 0; k < 3; ++k) {
    const float* x = &mesh.positions[3 * size_t{mesh.indices[3 * size_t{triangle} + k]}];
    v[k] = m.point(mesh.origin + Vec3{double{x[0]}, double{x[1]}, double{x[2]}});
  }
  const LampShape s = flat(LampShape::Kind::triangle, v[0], v[1] - v[0], v[2] - v[0], m.determinant() < 0);
  return s.area > 0 ? std::optional(s) : std::nullopt;
}

LightBounds bounds_of(const LampShape& s) {
  LightBounds b;
  b.power = kPi * s.area;
  if (s.kind == LampShape::Kind::sphere) {
    const Vec3 r{s.a.x, s.a.x, s.a.x};
    b.box = {s.origin - r, s.origin + r};
    b.cone = kPi;
    return b;
  }
  const bool disk = s.kind == LampShape::Kind::disk;
  for (int c = 0; c < (s.kind == LampShape::Kind::triangle ? 3 : 4); ++c) {
    const double x = disk ? (c & 1 ? 1 : -1) : (c & 1), y = disk ? (c & 2 ? 1 : -1) : (c >> 1);
    b.box.grow(s.origin + s.a * x + s.b * y);
  }
  b.axis = s.normal;
  b.both_sides = s.both_sides;
  if (s.both_sides) b.power *= 2;
  return b;
}

Vec3 place_on(const LampShape& s, Vec2 u) {
  if (s.kind == LampShape::Kind::sphere) return s.origin + uniform_sphere(u) * s.a.x;
  if (s.kind == LampShape::Kind::disk) u = disk_from_square(u);
  if (s.kind == LampShape::Kind::triangle) {
    const double root = std::sqrt(u.x);
    u = {root * (1 - u.y), root * u.y};
  }
  return s.origin + s.a * u.x + s.b * u.y;
}

std::optional<ShapePoint> draw(const LampShape& s, Vec3 from, Vec2 u) {
  ShapePoint p{s.origin, s.normal, 0, 0, {}, 0};
  if (s.kind == LampShape::Kind::sphere) {
    const double radius = s.a.x, drop = cone_drop(s, from);
    if (drop > 0) {
      // Uniform in the cone that the sphere fills; the point on the near side in that direction.
      const Vec3 to = s.origin - from;
      const Dir d = Frame::around(normalized(to)).to_world(uniform_cone(u, drop));
      // (By the closest approach: of large distances the squares would leave nothing.)
      const Vec3 closest = d * dot(to, d) - to;
      const double off2 = std::max(0.0, radius * radius - dot(closest, closest));
      p.normal = normalized(closest - d * std::sqrt(off2));
    } else {
      p.normal = uniform_sphere(u);
    }
    p.position = s.origin + p.normal * radius;
  } else {
    p.position = place_on(s, u);
  }
  const Vec3 to = p.position - from;
  p.distance = length(to);
  if (!(p.distance > 0)) return std::nullopt;
  p.direction = to / p.distance;
  p.cosine = -dot(p.direction, p.normal);
  if (p.cosine == 0 || (p.cosine < 0 && !s.both_sides)) return std::nullopt;
  p.density = density_of(s, from, p.distance, p.cosine);
  return p;
}

double density_of(const LampShape& s, Vec3 from, double distance, double cosine) {
  // From outside the near side is drawn, never the inner one, which rays meet through holes.
  if (s.kind == LampShape::Kind::sphere)
    if (const double drop = cone_drop(s, from); drop > 0) return cosine > 0 ? 1 / (2 * kPi * drop) : 0;
  return distance * distance / (std::max(std::fabs(cosine), 1e-12) * s.area);
}

}  // namespace suite
