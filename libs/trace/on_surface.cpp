// Hits on places of surfaces that are chosen rather than met by a ray.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "scene/primitives.h"
#include "trace/tracer.h"

namespace suite {

namespace {

// How far off a surface rays start: units of the last float place, and of the scene's double coordinates.
double step_off(double reach, Vec3 position) {
  return 8 * FLT_EPSILON * reach + 1e-15 * (std::fabs(position.x) + std::fabs(position.y) + std::fabs(position.z));
}

}  // namespace

Hit Tracer::on_triangle(uint32_t number, uint32_t triangle, double u, double v, double time) const {
  const TracedObject o = object(number);
  const Mesh& mesh = scene().meshes[o.mesh];
  mesh.require();
  const auto vertex = [&](uint32_t corner) {
    const float* f = &mesh.positions[3 * size_t{mesh.indices[3 * size_t{triangle} + corner]}];
    return Vec3{f[0], f[1], f[2]};
  };
  const Vec3 p0 = vertex(0), e1 = vertex(1) - p0, e2 = vertex(2) - p0, within = e1 * u + e2 * v;
  const Vec3 local = mesh.origin + p0 + within;
  // As packets have it (packet.cpp): the largest coordinate that is rounded to float on the way to the surface.
  const Affine3 to_world = this->to_world(number, time);
  const Vec3 p = local - mesh.origin;
  double reach = std::max(1e-6, 1e-3 * length(bounds_.high - bounds_.low));
  for (size_t k = 0; k < 9; k += 3)
    for (const Vec3& q : {p, within})
      reach = std::max(reach, std::fabs(to_world.a[k] * q.x) + std::fabs(to_world.a[k + 1] * q.y) +
                                  std::fabs(to_world.a[k + 2] * q.z));
  Hit hit;
  hit.position = to_world.point(local);
  hit.normal = normalized(to_world.normal(cross(e1, e2)));
  if (to_world.determinant() < 0) hit.normal = -hit.normal;
  hit.time = time;
  hit.object = number;
  hit.triangle = triangle;
  hit.u = static_cast<float>(u), hit.v = static_cast<float>(v);
  hit.step = static_cast<float>(step_off(reach, hit.position));
  hit.span = static_cast<float>(2 * length(bounds_.high - bounds_.low));
  return hit;
}

Hit Tracer::on_exact(uint32_t number, Vec3 local, Vec3 normal, Vec2 uv, double time) const {
  const Affine3 to_world = this->to_world(number, time);
  // Exact surfaces stand in tiles of at most a few kilometres, or of their own size; those without bounds are met in
  // double.
  constexpr double kTile = 8000;
  const Box3 box = primitive_box(scene().primitives[object(number).primitive]);
  const double reach = box.empty() ? 0
                                   : std::min(length(bounds_.high - bounds_.low),
                                              std::max(kTile, length(transformed(box, to_world).size())));
  Hit hit;
  hit.position = to_world.point(local);
  hit.normal = normalized(to_world.normal(normal));
  if (to_world.determinant() < 0) hit.normal = -hit.normal;
  hit.time = time;
  hit.object = number;
  hit.u = static_cast<float>(uv.x), hit.v = static_cast<float>(uv.y);
  hit.step = static_cast<float>(step_off(reach, hit.position) + 1e-9 + 64 * DBL_EPSILON * length(hit.position));
  return hit;
}

}  // namespace suite
