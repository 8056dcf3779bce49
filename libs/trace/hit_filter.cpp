// Surfaces with holes: Embree's callback for triangles, and the same question for exact surfaces. The ray is looked up
// in the caller's list, so the filter sees it unrounded.
#include "trace/hit_filter.h"

#include <algorithm>
#include <cmath>

#include "trace/embree_internal.h"

namespace suite {

bool World::keeps(const Ray& ray, const Asked& asked, uint32_t triangle, double u, double v, Vec3 position,
                  Vec3 normal) const {
  Hit hit;
  hit.position = position;
  hit.normal = normal;
  hit.time = ray.time;
  hit.object = asked.number;
  hit.triangle = triangle;
  hit.u = static_cast<float>(u), hit.v = static_cast<float>(v);
  return filter->keeps(ray, asked.object, hit);
}

std::optional<LocalHit> World::meet(const Ray& ray, const Asked& asked, const ExactPose& pose, double from,
                                    double t_min, double t_max) const {
  const Primitive& primitive = scene->primitives[asked.object.primitive];
  const Vec3 origin = pose.to_local.point(ray.origin + ray.direction * from),
             direction = pose.to_local.vector(ray.direction);
  auto found = intersect(primitive, origin, direction, t_min, t_max);
  if (!asked.may_pass) return found;
  while (found && !keeps(ray, asked, 0, found->u, found->v, ray.origin + ray.direction * (from + found->t),
                         pose.to_world.normal(found->normal)))
    found = intersect(primitive, origin, direction, again(found->t), t_max);
  return found;
}

// In the tile itself the geometry knows whose it is: its user data is the scene's object.
static uint32_t direct_object(const RTCFilterFunctionNArguments* args) {
  return static_cast<uint32_t>(reinterpret_cast<uintptr_t>(args->geometryUserPtr));
}

void gather_triangles(const RTCFilterFunctionNArguments* args) {
  const auto& context = *static_cast<const TraceContext*>(args->context);
  const World& world = *context.world;
  const uint32_t number = context.set ? world.number(context) : world.flat.number(direct_object(args));
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    context.gathered->push_back({number, RTCHitN_primID(args->hit, args->N, i), RTCHitN_u(args->hit, args->N, i),
                                 RTCHitN_v(args->hit, args->N, i), std::nullopt});
    args->valid[i] = 0;
  }
}

void filter_triangles(const RTCFilterFunctionNArguments* args) {
  const auto& context = *static_cast<const TraceContext*>(args->context);
  const World& world = *context.world;
  const uint32_t own = context.outer ? kNone : context.set ? context.set->objects[context.prim] : direct_object(args);
  if (own != kNone && !world.may_pass[own]) return;
  const Way way = own != kNone ? world.flat.way(own) : world.way(context);
  const Asked asked = own != kNone ? world.asked(own) : world.asked(way);
  if (!asked.may_pass) return;
  const Mesh& m = world.scene->meshes[way.object.mesh];
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const Ray& ray = context.enu_ray(RTCRayN_id(args->ray, args->N, i));
    const uint32_t triangle = RTCHitN_primID(args->hit, args->N, i);
    const double u = RTCHitN_u(args->hit, args->N, i), v = RTCHitN_v(args->hit, args->N, i);
    Vec3 p[3];
    for (size_t c = 0; c < 3; ++c) {
      const float* f = &m.positions[3 * size_t{m.indices[3 * size_t{triangle} + c]}];
      p[c] = {f[0], f[1], f[2]};
    }
    const double time =
        context.moving ? std::clamp(ray.time, context.moving->window.begin, context.moving->window.end) : 0;
    const Vec3 position = world.to_world(way, time).point(m.origin + p[0] * (1 - u - v) + p[1] * u + p[2] * v);
    if (!world.keeps(ray, asked, triangle, u, v, position)) args->valid[i] = 0;
  }
}

}  // namespace suite
