// Embree's callback for triangles with holes, and exact surfaces with holes. The ray is looked up in the caller's list,
// so the filter sees it unrounded.
#include "trace/hit_filter.h"

#include <algorithm>
#include <cmath>

#include "trace/embree_internal.h"

namespace suite {

std::optional<LocalHit> World::meet(uint32_t object, const Ray& ray, Vec3 origin, Vec3 direction, double ahead,
                                    double near, double far) const {
  const TracedObject& o = flat.objects[object];
  const Primitive& primitive = scene->primitives[o.primitive];
  auto found = intersect(primitive, origin, direction, near, far);
  if (!has_holes(object)) return found;
  Hit hit;
  hit.object = object;
  while (found) {
    hit.position = ray.origin + ray.direction * (ahead + found->t);
    hit.normal = dot(found->normal, direction) < 0 ? -ray.direction : ray.direction;
    hit.u = static_cast<float>(found->u), hit.v = static_cast<float>(found->v);
    if (filter->keeps(ray, o, hit)) break;
    found = intersect(primitive, origin, direction, found->t + 1e-12 * std::max(1.0, std::fabs(found->t)), far);
  }
  return found;
}

void filter_triangles(const RTCFilterFunctionNArguments* args) {
  const auto& context = *static_cast<const TraceContext*>(args->context);
  const World& world = *context.world;
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const unsigned id = RTCRayN_id(args->ray, args->N, i);
    const bool direct = context.object == kNone;
    Hit hit;
    hit.object = direct ? context.tile->direct[RTCHitN_geomID(args->hit, args->N, i)] : context.object;
    if (!world.has_holes(hit.object)) continue;
    const Ray& ray = context.rays[context.packet->ray[direct ? id : context.lane[id]]];
    hit.triangle = RTCHitN_primID(args->hit, args->N, i);
    hit.u = RTCHitN_u(args->hit, args->N, i), hit.v = RTCHitN_v(args->hit, args->N, i);
    const TracedObject& o = world.flat.objects[hit.object];
    const Mesh& m = world.scene->meshes[o.mesh];
    Vec3 p[3];
    for (size_t c = 0; c < 3; ++c) {
      const float* f = &m.positions[3 * size_t{m.indices[3 * size_t{hit.triangle} + c]}];
      p[c] = {f[0], f[1], f[2]};
    }
    const double time =
        context.moving ? std::clamp(ray.time, context.moving->window.begin, context.moving->window.end) : 0;
    hit.position = world.to_world(o, time).point(m.origin + p[0] * (1.0 - hit.u - hit.v) + p[1] * double{hit.u} +
                                                 p[2] * double{hit.v});
    if (!world.filter->keeps(ray, o, hit)) args->valid[i] = 0;
  }
}

}  // namespace suite
