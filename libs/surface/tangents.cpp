#include "surface/tangents.h"

#include <cmath>

#include "scene/primitives.h"

namespace suite {

namespace {

// Of a ring at constant height: u = radius share, v = azimuth / 2 pi.
SurfaceTangents of_ring(double inner, double outer, Vec3 p) {
  const double r = std::hypot(p.x, p.y);
  if (r == 0) return {};
  return {{(outer - inner) * p.x / r, (outer - inner) * p.y / r, 0}, {-2 * kPi * p.y, 2 * kPi * p.x, 0}};
}

// Side of a cone or its caps: u = azimuth / 2 pi, v = height share.
SurfaceTangents of_cone(double r0, double r1, double h, Vec3 p, Dir n) {
  if (std::fabs(n.z) > 1 - 1e-12) return of_ring(0, n.z < 0 ? r0 : r1, p);
  const double r = std::hypot(p.x, p.y);
  if (r == 0) return {};
  return {{-2 * kPi * p.y, 2 * kPi * p.x, 0}, {(r1 - r0) * p.x / r, (r1 - r0) * p.y / r, h}};
}

SurfaceTangents of_box(const std::vector<double>& a, Dir n) {
  if (is_layer(a)) return {{1, 0, 0}, {0, 1, 0}};
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::fabs(n[i]) > std::fabs(n[axis])) axis = i;
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  SurfaceTangents t;
  t.dpdu[b] = a[static_cast<size_t>(3 + b)] - a[static_cast<size_t>(b)];
  t.dpdv[c] = a[static_cast<size_t>(3 + c)] - a[static_cast<size_t>(c)];
  return t;
}

SurfaceTangents of_sinusoid(const std::vector<double>& a, Vec3 p) {
  double along_x = 0, along_y = 0;
  for (size_t i = 2; i < a.size(); i += 4) {
    const double c = a[i] * std::cos(a[i + 1] * p.x + a[i + 2] * p.y + a[i + 3]);
    along_x += c * a[i + 1], along_y += c * a[i + 2];
  }
  return {{a[0], 0, along_x * a[0]}, {0, a[1], along_y * a[1]}};
}

// In the primitive's local frame; see libs/scene/primitives.cpp for the coordinates of each kind.
SurfaceTangents of_primitive(const Primitive& primitive, Vec3 p, Dir n) {
  const std::vector<double>& a = primitive.parameters;
  switch (primitive.kind) {
    case PrimitiveKind::plane:
      return a[0] == 0 ? SurfaceTangents{{1, 0, 0}, {0, 1, 0}} : SurfaceTangents{{a[0], 0, 0}, {0, a[1], 0}};
    case PrimitiveKind::disk:
      return of_ring(a[1], a[0], p);
    case PrimitiveKind::box:
      return of_box(a, n);
    case PrimitiveKind::sphere: {
      const double r = std::hypot(p.x, p.y);
      if (r == 0) return {};
      return {{-2 * kPi * p.y, 2 * kPi * p.x, 0}, {kPi * p.z * p.x / r, kPi * p.z * p.y / r, -kPi * r}};
    }
    case PrimitiveKind::cone:
      return of_cone(a[0], a[1], a[2], p, n);
    case PrimitiveKind::cylinder:
      return of_cone(a[0], a[0], a[1], p, n);
    case PrimitiveKind::sinusoid:
      return of_sinusoid(a, p);
  }
  return {};
}

SurfaceTangents of_triangle(const Mesh& mesh, uint32_t triangle) {
  const uint32_t* i = &mesh.indices[3 * size_t{triangle}];
  Vec3 p[3];
  Vec2 t[3];
  for (size_t c = 0; c < 3; ++c) {
    const float* f = &mesh.positions[3 * size_t{i[c]}];
    p[c] = {f[0], f[1], f[2]};
    t[c] = {mesh.uvs[2 * size_t{i[c]}], mesh.uvs[2 * size_t{i[c]} + 1]};
  }
  const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
  const double u1 = t[1].x - t[0].x, v1 = t[1].y - t[0].y, u2 = t[2].x - t[0].x, v2 = t[2].y - t[0].y;
  const double det = u1 * v2 - u2 * v1;
  if (!(std::fabs(det) > 1e-12 * (std::hypot(u1, v1) * std::hypot(u2, v2)))) return {};
  return {(e1 * v2 - e2 * v1) / det, (e2 * u1 - e1 * u2) / det};
}

}  // namespace

Vec2 uv_at(const Scene& scene, const TracedObject& object, uint32_t triangle, double u, double v) {
  if (object.mesh == kNone || scene.meshes[object.mesh].uvs.empty()) return {u, v};
  const Mesh& mesh = scene.meshes[object.mesh];
  const uint32_t* i = &mesh.indices[3 * size_t{triangle}];
  const auto at = [&](size_t c) {
    return (1.0 - u - v) * mesh.uvs[2 * size_t{i[0]} + c] + u * mesh.uvs[2 * size_t{i[1]} + c] +
           v * mesh.uvs[2 * size_t{i[2]} + c];
  };
  return {at(0), at(1)};
}

SurfaceTangents tangents_at(const Scene& scene, const Affine3& to_world, const TracedObject& object, const Hit& hit) {
  SurfaceTangents t;
  if (object.primitive != kNone) {
    const auto& a = to_world.a;  // normals go back with the transpose
    const Vec3 n = hit.normal;
    const Vec3 local{a[0] * n.x + a[3] * n.y + a[6] * n.z, a[1] * n.x + a[4] * n.y + a[7] * n.z,
                     a[2] * n.x + a[5] * n.y + a[8] * n.z};
    t = of_primitive(scene.primitives[object.primitive], to_world.inverse().point(hit.position), normalized(local));
  } else if (!scene.meshes[object.mesh].uvs.empty()) {
    t = of_triangle(scene.meshes[object.mesh], hit.triangle);
  }
  t = {to_world.vector(t.dpdu), to_world.vector(t.dpdv)};
  const double area = length(cross(t.dpdu, t.dpdv));
  if (area > 1e-12 * length(t.dpdu) * length(t.dpdv) && area > 0) return t;
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}}) {
    const Vec3 world = to_world.vector(axis), along = world - hit.normal * dot(world, hit.normal);
    if (length(along) > 1e-3 * length(world)) return {normalized(along), cross(hit.normal, normalized(along))};
  }
  return {};  // cannot be: two axes are not both upright
}

}  // namespace suite
