// Embree's callbacks for exact surfaces. They compute in double; the hit is found once more with the unrounded ray when
// it is reported, so what float does to the ray only decides which surface is nearest.
#include <algorithm>
#include <cmath>

#include "trace/embree_internal.h"

namespace suite {

namespace {

void primitive_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& set = *static_cast<const PrimitiveSet*>(args->geometryUserPtr);
  const Box3& b = set.members[args->primID].bounds;
  RTCBounds& out = *args->bounds_o;
  const auto low = [&](double x) { return static_cast<float>(x - set.slack); };
  const auto high = [&](double x) { return static_cast<float>(x + set.slack); };
  const Vec3 l = b.low - set.origin, h = b.high - set.origin;
  out.lower_x = low(l.x), out.lower_y = low(l.y), out.lower_z = low(l.z);
  out.upper_x = high(h.x), out.upper_y = high(h.y), out.upper_z = high(h.z);
}

// The first hit that the filter does not let through.
std::optional<LocalHit> meet_kept(const PrimitiveSet& set, const RTCIntersectContext* where, unsigned id, unsigned lane, Vec3 o, Vec3 d, double t_min,
                                  double t_max) {
  const auto& context = *reinterpret_cast<const FilterContext*>(where);
  const uint32_t object = set.members[id].object;
  auto found = set.meet(id, o, d, t_min, t_max);
  if (!context.core->filter || !context.core->may_pass[object]) return found;
  const Ray& ray = context.rays[context.packet->ray[lane]];
  while (found && !context.core->keeps(*context.tracer, ray, object, 0, found->u, found->v, set.origin + o + d * found->t,
                                                     context.tracer->objects()[object].to_world.normal(found->normal)))
    found = set.meet(id, o, d, found->t + 1e-12 * std::max(1.0, std::fabs(found->t)), t_max);
  return found;
}

void primitive_intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& set = *static_cast<const PrimitiveSet*>(args->geometryUserPtr);
  RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const Vec3 o{RTCRayN_org_x(ray, args->N, i), RTCRayN_org_y(ray, args->N, i), RTCRayN_org_z(ray, args->N, i)};
    const Vec3 d{RTCRayN_dir_x(ray, args->N, i), RTCRayN_dir_y(ray, args->N, i), RTCRayN_dir_z(ray, args->N, i)};
    const auto found = meet_kept(set, args->context, args->primID, RTCRayN_id(ray, args->N, i), o, d, RTCRayN_tnear(ray, args->N, i),
                                 RTCRayN_tfar(ray, args->N, i));
    if (!found) continue;
    RTCRayN_tfar(ray, args->N, i) = static_cast<float>(found->t);
    RTCHitN_u(hit, args->N, i) = RTCHitN_v(hit, args->N, i) = 0;
    RTCHitN_primID(hit, args->N, i) = args->primID;
    RTCHitN_geomID(hit, args->N, i) = args->geomID;
    RTCHitN_instID(hit, args->N, i, 0) = RTC_INVALID_GEOMETRY_ID;
  }
}

void primitive_occluded(const RTCOccludedFunctionNArguments* args) {
  const auto& set = *static_cast<const PrimitiveSet*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const Vec3 o{RTCRayN_org_x(args->ray, args->N, i), RTCRayN_org_y(args->ray, args->N, i), RTCRayN_org_z(args->ray, args->N, i)};
    const Vec3 d{RTCRayN_dir_x(args->ray, args->N, i), RTCRayN_dir_y(args->ray, args->N, i), RTCRayN_dir_z(args->ray, args->N, i)};
    if (meet_kept(set, args->context, args->primID, RTCRayN_id(args->ray, args->N, i), o, d, RTCRayN_tnear(args->ray, args->N, i),
                  RTCRayN_tfar(args->ray, args->N, i)))
      RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
  }
}

}  // namespace

void attach_primitives(RTCScene scene, const PrimitiveSet& set, unsigned id) {
  RTCGeometry g = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(set.members.size()));
  rtcSetGeometryUserData(g, const_cast<PrimitiveSet*>(&set));
  rtcSetGeometryBoundsFunction(g, primitive_bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, primitive_intersect);
  rtcSetGeometryOccludedFunction(g, primitive_occluded);
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(scene, g, id);
  rtcReleaseGeometry(g);
}

}  // namespace suite
