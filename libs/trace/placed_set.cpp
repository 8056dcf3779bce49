// Embree's callbacks for instances and exact surfaces. They take the unrounded rays into the instance's own frame in
// double, to where they enter its box, and only there become float: nothing is lost with distance, size or speed.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "base/parallel.h"
#include "trace/embree_internal.h"
#include "trace/go_in.h"
#include "trace/primitive_hit.h"

namespace suite {

namespace {

// An object as the ray sees it at its time.
bool go_in(const PlacedSet& set, unsigned prim, const MeshEntry& mesh, const Ray& ray, double near, double far,
           LocalRay& out) {
  if (set.partly && !set.moving->there(set.objects[prim], ray.time)) return false;
  if (!set.inverse.empty()) return go_in(RestingInward(set.inverse[prim]), mesh.room, ray, near, far, out);
  const PlacedObject& o = set.frame->objects[set.objects[prim]];
  const Affine3 to_world = set.moving->to_world(o, ray.time), inverse = to_world.inverse();
  return go_in(Inward{to_world.point(set.zero_of(set.objects[prim])), inverse.a.data()}, mesh.room, ray, near, far,
               out);
}

// The exact surface that a context is at, as the unrounded rays meet it: in ENU, whatever groups it is in. Distances
// are those of the context's frame.
struct ExactSurface {
  const PlacedSet& set;
  const TraceContext& context;
  const Way way;
  const Asked asked;

  ExactSurface(const PlacedSet& s, const TraceContext& c)
      : set(s), context(c), way(s.world->way(c)), asked(c.outer ? s.world->asked(way) : s.world->asked(object())) {}
  uint32_t object() const { return set.objects[context.prim]; }
  // Where the packet's start of a lane is on the ray.
  double from(unsigned lane) const { return context.start + context.packet->advance[lane] / context.stretch; }

  std::optional<LocalHit> meet(unsigned lane, double near, double far) const {
    const Ray& ray = context.enu_ray(lane);
    if (set.partly && !set.moving->there(object(), ray.time)) return std::nullopt;
    const bool moves = context.moving && way.object.node != kNone;
    std::optional<Affine3> moved;
    if (moves) moved = context.moving->nodes[way.object.node].at(ray.time) * way.place;
    auto found = set.world->meet(ray, asked, ExactPose(moved ? *moved : way.place), from(lane), near / context.stretch,
                                 far / context.stretch);
    if (found) found->t *= context.stretch;
    return found;
  }
};

// The unrounded ray of a lane, into an instance; false when it does not get there.
bool enter(const PlacedSet& set, unsigned prim, const MeshEntry& mesh, const TraceContext& context, RTCRayN* rays,
           unsigned n, unsigned i, LocalRay& in) {
  const unsigned lane = RTCRayN_id(rays, n, i);
  const double advance = context.packet->advance[lane];
  in.id = lane;
  return go_in(set, prim, mesh, context.ray(lane), advance + double{RTCRayN_tnear(rays, n, i)},
               context.reach_of(lane, RTCRayN_tfar(rays, n, i)), in);
}

void intersect_one(const RTCIntersectFunctionNArguments* args, unsigned i, const MeshEntry& entry, const LocalRay& in) {
  auto* context = static_cast<TraceContext*>(args->context);
  alignas(16) RTCRayHit one;
  load(in, one.ray);
  one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(entry.handle.scene, context, &one);
  if (one.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
  const double t = in.enter + double{one.ray.tfar} / in.stretch;
  hand_out(args, i, t - context->packet->advance[in.id], one.hit.u, one.hit.v, one.hit.primID);
}

// Whether all rays of a callback run alongside each other, and what they come to is smooth enough for them to go on so:
// then one query for eight takes less than eight for one. Among leaves, and where fewer enter, it takes longer.
bool together(unsigned rays, const MeshEntry& mesh, const TraceContext& context) {
  return rays == kWidth && (context.flags & RTC_INTERSECT_CONTEXT_FLAG_COHERENT) && !mesh.loose;
}

void intersect_eight(const RTCIntersectFunctionNArguments* args, const MeshEntry& entry,
                     const std::array<LocalRay, kWidth>& in) {
  auto* context = static_cast<TraceContext*>(args->context);
  alignas(32) RTCRayHit8 all;
  alignas(32) int valid[kWidth];
  load(in, all.ray, valid);
  for (unsigned k = 0; k < kWidth; ++k) all.hit.geomID[k] = all.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect8(valid, entry.handle.scene, context, &all);
  for (unsigned k = 0; k < kWidth; ++k) {
    if (all.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
    const double t = in[k].enter + double{all.ray.tfar[k]} / in[k].stretch;
    hand_out(args, k, t - context->packet->advance[in[k].id], all.hit.u[k], all.hit.v[k], all.hit.primID[k]);
  }
}

void intersect_together(const RTCIntersectFunctionNArguments* args, const PlacedSet& set, const MeshEntry& entry) {
  const auto& context = *static_cast<const TraceContext*>(args->context);
  std::array<LocalRay, kWidth> in;
  std::array<bool, kWidth> enters;
  for (unsigned i = 0; i < kWidth; ++i)
    enters[i] = args->valid[i] &&
                enter(set, args->primID, entry, context, RTCRayHitN_RayN(args->rayhit, kWidth), kWidth, i, in[i]);
  if (std::all_of(enters.begin(), enters.end(), [](bool e) { return e; })) return intersect_eight(args, entry, in);
  for (unsigned i = 0; i < kWidth; ++i)
    if (enters[i]) intersect_one(args, i, entry, in[i]);
}

void intersect_mesh(const RTCIntersectFunctionNArguments* args, const PlacedSet& set, uint32_t mesh) {
  auto* context = static_cast<TraceContext*>(args->context);
  RTCRayN* outer = RTCRayHitN_RayN(args->rayhit, args->N);
  const MeshEntry& entry = set.world->meshes[mesh];
  context->set = &set, context->prim = args->primID;
  if (together(args->N, entry, *context))
    intersect_together(args, set, entry);
  else
    for (unsigned i = 0; i < args->N; ++i)
      if (LocalRay in; args->valid[i] && enter(set, args->primID, entry, *context, outer, args->N, i, in))
        intersect_one(args, i, entry, in);
  context->set = nullptr;
}

void intersect_exact(const RTCIntersectFunctionNArguments* args, const PlacedSet& set) {
  auto* context = static_cast<TraceContext*>(args->context);
  RTCRayN* outer = RTCRayHitN_RayN(args->rayhit, args->N);
  context->set = &set, context->prim = args->primID;
  const ExactSurface surface(set, *context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const unsigned lane = RTCRayN_id(outer, args->N, i);
    const double far = RTCRayN_tfar(outer, args->N, i);
    auto found = surface.meet(lane, RTCRayN_tnear(outer, args->N, i), far);
    for (; context->gathered && found; found = surface.meet(lane, World::again(found->t), far)) {
      context->gathered->push_back({set.world->number(*context), 0, 0, 0, found});
      context->gathered->back().exact->t = surface.from(lane) + found->t / context->stretch;
    }
    if (found) hand_out(args, i, found->t, 0, 0, 0);
  }
  context->set = nullptr;
}

// An exact surface that rests and has no holes, where rays look for the nearest hit: PacketTracer then finds its exact
// place.
struct PlainSurface {
  const PlacedSet& set;
  const TraceContext& context;
  const uint32_t object;
  const RestingInward inward;
  const Primitive& primitive;

  PlainSurface(const PlacedSet& s, const TraceContext& c, unsigned prim)
      : set(s),
        context(c),
        object(s.objects[prim]),
        inward(s.inverse[prim]),
        primitive(s.world->scene->primitives[s.inverse[prim].thing - PlacedSet::Inverse::kExact]) {}
  // Where a ray outside meets it; infinity: nowhere.
  double meet(RTCRayN* rays, unsigned n, unsigned i) const {
    const unsigned lane = RTCRayN_id(rays, n, i);
    const Ray& ray = context.ray(lane);
    if (set.partly && !set.moving->there(object, ray.time)) return INFINITY;
    const SeenRay seen(inward, ray);
    const double before = seen.closest - context.packet->advance[lane];
    return before + distance_to(primitive, seen.origin, seen.direction, double{RTCRayN_tnear(rays, n, i)} - before,
                                context.reach_of(lane, RTCRayN_tfar(rays, n, i)) - seen.closest);
  }
};

void intersect_plain(const RTCIntersectFunctionNArguments* args, const PlacedSet& set) {
  const PlainSurface surface(set, *static_cast<const TraceContext*>(args->context), args->primID);
  RTCRayN* outer = RTCRayHitN_RayN(args->rayhit, args->N);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    if (const double t = surface.meet(outer, args->N, i); t < INFINITY) hand_out(args, i, t, 0, 0, 0);
  }
}

void occlude_plain(const RTCOccludedFunctionNArguments* args, const PlacedSet& set) {
  const PlainSurface surface(set, *static_cast<const TraceContext*>(args->context), args->primID);
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i] && surface.meet(args->ray, args->N, i) < INFINITY)
      RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
}

// What is placed there: as Inverse::thing.
uint32_t thing_at(const PlacedSet& set, unsigned prim) {
  return set.inverse.empty() ? set.frame->objects[set.objects[prim]].mesh : set.inverse[prim].thing;
}

void intersect_placed(const RTCIntersectFunctionNArguments* args) {
  const auto& set = *static_cast<const PlacedSet*>(args->geometryUserPtr);
  const uint32_t thing = thing_at(set, args->primID);
  if (thing < PlacedSet::Inverse::kExact)
    intersect_mesh(args, set, thing);
  else if (thing != kNone && !static_cast<const TraceContext*>(args->context)->gathered)
    intersect_plain(args, set);
  else
    intersect_exact(args, set);
}

void occlude_mesh(const RTCOccludedFunctionNArguments* args, const PlacedSet& set, uint32_t mesh) {
  auto* context = static_cast<TraceContext*>(args->context);
  const MeshEntry& entry = set.world->meshes[mesh];
  context->set = &set, context->prim = args->primID;
  for (unsigned i = 0; i < args->N; ++i) {
    LocalRay in;
    if (!args->valid[i] || !enter(set, args->primID, entry, *context, args->ray, args->N, i, in)) continue;
    alignas(16) RTCRay one;
    load(in, one);
    rtcOccluded1(entry.handle.scene, context, &one);
    if (one.tfar < 0) RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
  }
  context->set = nullptr;
}

void occlude_exact(const RTCOccludedFunctionNArguments* args, const PlacedSet& set) {
  auto* context = static_cast<TraceContext*>(args->context);
  context->set = &set, context->prim = args->primID;
  const ExactSurface surface(set, *context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const unsigned lane = RTCRayN_id(args->ray, args->N, i);
    const double far = context->reach_of(lane, RTCRayN_tfar(args->ray, args->N, i)) - context->packet->advance[lane];
    if (surface.meet(lane, RTCRayN_tnear(args->ray, args->N, i), far)) RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
  }
  context->set = nullptr;
}

void occlude_placed(const RTCOccludedFunctionNArguments* args) {
  const auto& set = *static_cast<const PlacedSet*>(args->geometryUserPtr);
  const uint32_t thing = thing_at(set, args->primID);
  if (thing < PlacedSet::Inverse::kExact)
    occlude_mesh(args, set, thing);
  else if (thing != kNone)
    occlude_plain(args, set);
  else
    occlude_exact(args, set);
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

Vec3 PlacedSet::zero_of(uint32_t object) const {
  const uint32_t group = frame->shared_of(object), mesh = frame->objects[object].mesh;
  return group != kNone ? world->groups[group].origin : mesh != kNone ? world->scene->meshes[mesh].origin : Vec3{};
}

uint32_t PlacedSet::number_of(uint32_t object) const {
  return frame == &world->flat ? world->flat.number(object) : frame->objects[object].instance;
}

uint32_t PlacedSet::thing_of(uint32_t object) const {
  const PlacedObject& o = frame->objects[object];
  if (o.mesh != kNone) return o.mesh;
  // What is above a group may decide about its holes.
  const bool holed = world->filter && (frame != &world->flat || world->may_pass[object]);
  return holed ? kNone : Inverse::kExact + o.primitive;
}

void PlacedSet::fill_inverse() {
  if (groups)
    deep.resize(objects.size());
  else
    inverse.resize(objects.size());
  parallel_for(0, objects.size(), 4096, [&](size_t b, size_t e) {
    for (size_t k = b; k < e; ++k) {
      const PlacedObject& o = frame->objects[objects[k]];
      if (!groups) inverse[k].thing = thing_of(objects[k]);
      const Affine3 place = moving ? moving->to_world(o, moving->window.begin) : *o.place, back = place.inverse();
      const Vec3 base = place.point(zero_of(objects[k]));
      if (groups) {
        deep[k].base = base;
        deep[k].group = frame->shared[objects[k]], deep[k].number = number_of(objects[k]);
        std::copy(back.a.begin(), back.a.end(), deep[k].linear);
      } else {
        inverse[k].base = base;
        for (size_t j = 0; j < 9; ++j) inverse[k].linear[j] = static_cast<float>(back.a[j % 3 * 3 + j / 3]);
      }
    }
  });
}

void PlacedSet::attach(RTCScene scene, unsigned id) {
  RTCGeometry g = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(objects.size()));
  rtcSetGeometryTimeStepCount(g, times);
  rtcSetGeometryUserData(g, this);
  rtcSetGeometryBoundsFunction(g, placed_bounds, nullptr);
  rtcSetGeometryIntersectFunction(g, groups ? intersect_groups : intersect_placed);
  rtcSetGeometryOccludedFunction(g, groups ? occlude_groups : occlude_placed);
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(scene, g, id);
  rtcReleaseGeometry(g);
}

}  // namespace suite
