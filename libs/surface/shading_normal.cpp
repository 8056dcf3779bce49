#include "surface/shading_normal.h"

#include <cmath>

namespace suite {

std::optional<Dir> vertex_normal(const Scene& scene, const Affine3& to_world, const TracedObject& object,
                                 const Hit& hit) {
  if (object.mesh == kNone || scene.meshes[object.mesh].normals.empty()) return std::nullopt;
  const Mesh& mesh = scene.meshes[object.mesh];
  const uint32_t* i = &mesh.indices[3 * size_t{hit.triangle}];
  const Vec3 local = oct_decode(mesh.normals[i[0]]) * (1.0 - hit.u - hit.v) +
                     oct_decode(mesh.normals[i[1]]) * double{hit.u} + oct_decode(mesh.normals[i[2]]) * double{hit.v};
  const Vec3 world = to_world.normal(local);
  const double len = length(world);
  const Dir n = len > 0 ? world / len : hit.normal;
  return dot(n, hit.normal) < 0 ? -n : n;  // against the winding: the winding decides the front
}

Dir bumped(Dir n, const PropertyMap& map, const MapPlace& place, const SurfaceTangents& t) {
  const Vec2 slope = slope_at(map, place);
  Vec3 gradient;
  if (map.projection == Projection::drape) {
    gradient = {slope.x / map.drape.gsd_x, -slope.y / map.drape.gsd_y, 0};
  } else {
    // Per unit of u and v to per metre: the basis dual to the tangents.
    const double hu = slope.x * map.width, hv = -slope.y * map.height;
    const double e = dot(t.dpdu, t.dpdu), f = dot(t.dpdu, t.dpdv), g = dot(t.dpdv, t.dpdv), det = e * g - f * f;
    if (!(det > 0)) return n;
    gradient = (t.dpdu * (g * hu - f * hv) + t.dpdv * (e * hv - f * hu)) / det;
  }
  return normalized(n - (gradient - n * dot(gradient, n)));
}

Dir mapped_normal(Dir n, const PropertyMap& map, const MapPlace& place, const SurfaceTangents& t) {
  float v[3];
  if (!values_at(map, place, v)) return n;
  Vec3 local{v[0], v[1], v[2]};
  const double len = length(local);
  if (!(len > 0)) return n;
  local = local / len;
  local.z = std::fmax(local.z, 1e-2);
  const bool drape = map.projection == Projection::drape;
  Frame frame = Frame::with_tangent(n, drape ? Vec3{1, 0, 0} : t.dpdu);
  if (!drape && dot(frame.y, t.dpdv) < 0) frame.y = -frame.y;  // mirrored texture: y stays along v
  return normalized(frame.to_world(local));
}

Dir kept_in_view(Dir n, Dir out, Dir true_normal) {
  const double side = dot(out, true_normal) >= 0 ? 1 : -1, seen = side * dot(out, n);
  return seen < 1e-3 ? normalized(n + out * (side * (1e-3 - seen))) : n;
}

}  // namespace suite
