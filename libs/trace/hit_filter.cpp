// Embree's callbacks for surfaces with holes. The ray is looked up in the caller's list, so the filter sees it
// unrounded.
#include "trace/hit_filter.h"

#include <algorithm>
#include <cmath>

#include "trace/embree_internal.h"

namespace suite {

bool TracerCore::keeps(const Tracer& t, const Ray& ray, uint32_t object, uint32_t triangle, double u, double v,
                       Vec3 position, Vec3 normal) const {
  Hit hit;
  hit.position = position;
  hit.normal = normal;
  hit.object = object;
  hit.triangle = triangle;
  hit.u = static_cast<float>(u), hit.v = static_cast<float>(v);
  return filter->keeps(ray, t.objects()[object], hit);
}

std::optional<LocalHit> TracerCore::meet_kept(const Tracer& t, const Ray& ray, uint32_t object, const Affine3& to_local,
                                              double t_min, double t_max) const {
  const Primitive& primitive = t.scene().primitives[t.objects()[object].primitive];
  const Vec3 origin = to_local.point(ray.origin), direction = to_local.vector(ray.direction);
  auto found = intersect(primitive, origin, direction, t_min, t_max);
  if (!filter || !may_pass[object]) return found;
  while (found && !keeps(t, ray, object, 0, found->u, found->v, ray.origin + ray.direction * found->t,
                         t.objects()[object].to_world.normal(found->normal)))
    found = intersect(primitive, origin, direction, found->t + 1e-12 * std::max(1.0, std::fabs(found->t)), t_max);
  return found;
}

void filter_triangles(const RTCFilterFunctionNArguments* args) {
  const auto& context = *reinterpret_cast<const FilterContext*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const unsigned instance = RTCHitN_instID(args->hit, args->N, i, 0);
    const unsigned id = instance != RTC_INVALID_GEOMETRY_ID ? instance : RTCHitN_geomID(args->hit, args->N, i);
    const uint32_t object = context.tile->objects[id], triangle = RTCHitN_primID(args->hit, args->N, i);
    if (!context.core->may_pass[object]) continue;
    const double u = RTCHitN_u(args->hit, args->N, i), v = RTCHitN_v(args->hit, args->N, i);
    const TracedObject& o = context.tracer->objects()[object];
    const Mesh& m = context.tracer->scene().meshes[o.mesh];
    Vec3 p[3];
    for (size_t c = 0; c < 3; ++c) {
      const float* f = &m.positions[3 * size_t{m.indices[3 * size_t{triangle} + c]}];
      p[c] = {f[0], f[1], f[2]};
    }
    const Vec3 position = o.to_world.point(m.origin + p[0] * (1 - u - v) + p[1] * u + p[2] * v);
    const Ray& ray = context.rays[context.packet->ray[RTCRayN_id(args->ray, args->N, i)]];
    if (!context.core->keeps(*context.tracer, ray, object, triangle, u, v, position)) args->valid[i] = 0;
  }
}

}  // namespace suite
