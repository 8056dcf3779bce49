// Embree's callbacks for instances and exact surfaces. They take the unrounded rays into the instance's own frame in
// double, to where they enter its box, and only there become float: nothing is lost with distance, size or speed.
#include <cfloat>
#include <cmath>

#include "base/parallel.h"
#include "trace/embree_internal.h"
#include "trace/primitive_hit.h"

namespace suite {

namespace {

// From ENU vectors to a local frame whose zero is at `base`.
template <class T>
struct Inward {
  Vec3 base;
  const T* a;  // row-major
  Vec3 vector(Vec3 v) const {
    return {a[0] * v.x + a[1] * v.y + a[2] * v.z, a[3] * v.x + a[4] * v.y + a[5] * v.z,
            a[6] * v.x + a[7] * v.y + a[8] * v.z};
  }
};

// A ray inside an instance: unit direction, its start where it enters the box.
struct LocalRay {
  Vec3 origin, direction;
  double enter;    // along the ray in ENU, m
  double stretch;  // local length of one metre
  double reach;    // local
  unsigned id;     // of the float ray outside
};

// The stretch of the ray between near and far that lies in the instance's box; false when there is none.
template <class T>
bool go_in(const Inward<T>& inward, const Box3& box, const Ray& ray, double near, double far, LocalRay& out) {
  // The point of the ray next to the instance, so that what float did to the matrix counts only over its size.
  const Vec3 away = ray.origin - inward.base;
  const double closest = -dot(away, ray.direction);
  const Vec3 o = inward.vector(away + ray.direction * closest), d = inward.vector(ray.direction);
  near -= closest, far -= closest;
  for (int i = 0; i < 3; ++i) {
    const double inverse = 1 / d[i], a = (box.low[i] - o[i]) * inverse, b = (box.high[i] - o[i]) * inverse;
    const double first = a > b ? b : a, last = a > b ? a : b;
    // 0 * infinity is NaN and does not clip; the box is wide enough for rounding.
    if (first > near) near = first;
    if (last < far) far = last;
  }
  if (!(near <= far)) return false;
  out.enter = near + closest;
  out.stretch = length(d);
  out.origin = o + d * near;
  out.direction = d / out.stretch;
  out.reach = (far - near) * out.stretch;
  return true;
}

// An object as the ray sees it at its time.
bool go_in(const PlacedSet& set, unsigned prim, const MeshEntry& mesh, const Ray& ray, double near, double far,
           LocalRay& out) {
  if (set.partly && !set.moving->there(set.objects[prim], ray.time)) return false;
  if (!set.inverse.empty()) {
    const PlacedSet::Inverse& inverse = set.inverse[prim];
    return go_in(Inward<float>{inverse.base, inverse.linear}, mesh.room, ray, near, far, out);
  }
  const TracedObject& o = set.world->flat.objects[set.objects[prim]];
  const Affine3 to_world = set.moving->to_world(o, ray.time), inverse = to_world.inverse();
  return go_in(Inward<double>{to_world.point(set.world->scene->meshes[o.mesh].origin), inverse.a.data()}, mesh.room,
               ray, near, far, out);
}

// Where the unrounded ray meets an exact surface, from the packet's start on.
std::optional<LocalHit> meet(const PlacedSet& set, uint32_t object, const Ray& ray, double advance, double near,
                             double far) {
  if (set.partly && !set.moving->there(object, ray.time)) return std::nullopt;
  const TracedObject& o = set.world->flat.objects[object];
  return set.world->meet(ray, object, set.moving ? set.moving->to_world(o, ray.time) : *o.place, advance, near, far);
}

// The unrounded ray of a lane, into an instance; false when it does not get there.
bool enter(const PlacedSet& set, unsigned prim, const MeshEntry& mesh, const TraceContext& context, RTCRayN* rays,
           unsigned n, unsigned i, LocalRay& in) {
  const unsigned lane = RTCRayN_id(rays, n, i);
  const double advance = context.packet->advance[lane];
  in.id = lane;
  return go_in(set, prim, mesh, context.ray(lane), advance + double{RTCRayN_tnear(rays, n, i)},
               advance + double{RTCRayN_tfar(rays, n, i)}, in);
}

void load(const LocalRay& r, RTCRay& q) {
  q.org_x = static_cast<float>(r.origin.x), q.org_y = static_cast<float>(r.origin.y),
  q.org_z = static_cast<float>(r.origin.z);
  q.dir_x = static_cast<float>(r.direction.x), q.dir_y = static_cast<float>(r.direction.y),
  q.dir_z = static_cast<float>(r.direction.z);
  q.tnear = 0, q.tfar = static_cast<float>(r.reach), q.time = 0, q.mask = 0xffffffffu, q.id = r.id, q.flags = 0;
}

// One ray after the other: those that enter an instance are few and rarely go the same way through its leaves, where a
// query for eight takes longer than eight for one.
void intersect_mesh(const RTCIntersectFunctionNArguments* args, const PlacedSet& set, uint32_t mesh) {
  auto* context = static_cast<TraceContext*>(args->context);
  RTCRayN* outer = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* found = RTCRayHitN_HitN(args->rayhit, args->N);
  const MeshEntry& entry = set.world->meshes[mesh];
  context->object = set.objects[args->primID];
  for (unsigned i = 0; i < args->N; ++i) {
    LocalRay in;
    if (!args->valid[i] || !enter(set, args->primID, entry, *context, outer, args->N, i, in)) continue;
    alignas(16) RTCRayHit one;
    load(in, one.ray);
    one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(entry.handle.scene, context, &one);
    if (one.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    const double t = in.enter + double{one.ray.tfar} / in.stretch;
    RTCRayN_tfar(outer, args->N, i) = static_cast<float>(t - context->packet->advance[in.id]);
    RTCHitN_u(found, args->N, i) = one.hit.u;
    RTCHitN_v(found, args->N, i) = one.hit.v;
    RTCHitN_primID(found, args->N, i) = one.hit.primID;
    RTCHitN_geomID(found, args->N, i) = args->geomID;
    RTCHitN_instID(found, args->N, i, 0) = args->primID;
  }
  context->object = kNone;
}

void intersect_exact(const RTCIntersectFunctionNArguments* args, const PlacedSet& set, uint32_t o) {
  const auto* context = static_cast<const TraceContext*>(args->context);
  RTCRayN* outer = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const unsigned lane = RTCRayN_id(outer, args->N, i);
    const Ray& ray = context->rays[context->packet->ray[lane]];
    const double advance = context->packet->advance[lane], far = RTCRayN_tfar(outer, args->N, i);
    auto found = meet(set, o, ray, advance, RTCRayN_tnear(outer, args->N, i), far);
    for (; context->gathered && found; found = meet(set, o, ray, advance, World::again(found->t), far)) {
      context->gathered->push_back({o, 0, 0, 0, found});
      context->gathered->back().exact->t += advance;
    }
    if (!found) continue;
    RTCRayN_tfar(outer, args->N, i) = static_cast<float>(found->t);
    RTCHitN_u(hit, args->N, i) = RTCHitN_v(hit, args->N, i) = 0;
    RTCHitN_primID(hit, args->N, i) = 0;
    RTCHitN_geomID(hit, args->N, i) = args->geomID;
    RTCHitN_instID(hit, args->N, i, 0) = args->primID;
  }
}

void intersect_placed(const RTCIntersectFunctionNArguments* args) {
  const auto& set = *static_cast<const PlacedSet*>(args->geometryUserPtr);
  const uint32_t mesh = set.inverse.empty() ? kNone : set.inverse[args->primID].mesh;
  if (mesh != kNone) return intersect_mesh(args, set, mesh);
  const TracedObject& o = set.world->flat.objects[set.objects[args->primID]];
  if (o.mesh != kNone)
    intersect_mesh(args, set, o.mesh);
  else
    intersect_exact(args, set, set.objects[args->primID]);
}

void occlude_mesh(const RTCOccludedFunctionNArguments* args, const PlacedSet& set, uint32_t mesh) {
  auto* context = static_cast<TraceContext*>(args->context);
  const MeshEntry& entry = set.world->meshes[mesh];
  context->object = set.objects[args->primID];
  for (unsigned i = 0; i < args->N; ++i) {
    LocalRay in;
    if (!args->valid[i] || !enter(set, args->primID, entry, *context, args->ray, args->N, i, in)) continue;
    alignas(16) RTCRay one;
    load(in, one);
    rtcOccluded1(entry.handle.scene, context, &one);
    if (one.tfar < 0) RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
  }
  context->object = kNone;
}

void occlude_placed(const RTCOccludedFunctionNArguments* args) {
  const auto& set = *static_cast<const PlacedSet*>(args->geometryUserPtr);
  const uint32_t mesh = set.inverse.empty() ? kNone : set.inverse[args->primID].mesh;
  if (mesh != kNone) return occlude_mesh(args, set, mesh);
  const TracedObject& o = set.world->flat.objects[set.objects[args->primID]];
  if (o.mesh != kNone) return occlude_mesh(args, set, o.mesh);
  const auto* context = static_cast<const TraceContext*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const unsigned lane = RTCRayN_id(args->ray, args->N, i);
    if (meet(set, set.objects[args->primID], context->rays[context->packet->ray[lane]], context->packet->advance[lane],
             RTCRayN_tnear(args->ray, args->N, i), RTCRayN_tfar(args->ray, args->N, i)))
      RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
  }
}

void placed_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& set = *static_cast<const PlacedSet*>(args->geometryUserPtr);
  const Box3& b = set.boxes[size_t{args->primID} * set.times + args->timeStep];
  const Vec3 l = b.low - set.origin, h = b.high - set.origin;
  RTCBounds& out = *args->bounds_o;
  const auto low = [](double x) { return std::nextafter(static_cast<float>(x), -INFINITY); };
  const auto high = [](double x) { return std::nextafter(static_cast<float>(x), INFINITY); };
  out.lower_x = low(l.x), out.lower_y = low(l.y), out.lower_z = low(l.z);
  out.upper_x = high(h.x), out.upper_y = high(h.y), out.upper_z = high(h.z);
}

}  // namespace

void PlacedSet::fill_inverse() {
  inverse.resize(objects.size());
  parallel_for(0, objects.size(), 4096, [&](size_t b, size_t e) {
    for (size_t k = b; k < e; ++k) {
      const TracedObject& o = world->flat.objects[objects[k]];
      inverse[k].mesh = o.mesh;
      if (o.mesh == kNone) continue;
      const Affine3 place = moving ? moving->to_world(o, moving->window.begin) : *o.place, back = place.inverse();
      inverse[k].base = place.point(world->scene->meshes[o.mesh].origin);
      for (size_t j = 0; j < 9; ++j) inverse[k].linear[j] = static_cast<float>(back.a[j]);
    }
  });
}

void PlacedSet::attach(RTCScene scene, unsigned id) {
  RTCGeometry g = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(objects.size()));
  rtcSetGeometryTimeStepCount(g, times);
  rtcSetGeometryUserData(g, this);
  rtcSetGeometryBoundsFunction(g, placed_bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, intersect_placed);
  rtcSetGeometryOccludedFunction(g, occlude_placed);
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(scene, g, id);
  rtcReleaseGeometry(g);
}

}  // namespace suite
