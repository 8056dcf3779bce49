// Groups that are kept once: their acceleration structures, and the way of rays into them and back.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "scene/primitives.h"
#include "trace/arrange.h"
#include "trace/embree_internal.h"
#include "trace/go_in.h"

namespace suite {

namespace {

// A placement of a shared group.
struct Target {
  const GroupEntry& group;
  uint32_t number;  // of its first object, within the frame

  static Target of(const PlacedSet& set, unsigned prim) {
    if (!set.deep.empty()) return {set.world->groups[set.deep[prim].group], set.deep[prim].number};
    const uint32_t object = set.objects[prim];
    return {set.world->groups[set.frame->shared[object]], set.number_of(object)};
  }
  // Takes the unrounded ray of a lane into it, from `near` beyond its advance to `far` along all of it; false when it
  // does not get there.
  bool enter(const PlacedSet& set, const TraceContext& outer, unsigned lane, double near, double far,
             LocalRay& in) const {
    const Ray& from = outer.ray(lane);
    near += outer.packet->advance[lane];
    if (set.partly && !set.moving->there(set.objects[outer.prim], from.time)) return false;
    if (!set.deep.empty()) {
      const PlacedSet::DeepInverse& inverse = set.deep[outer.prim];
      return go_in(Inward{inverse.base, inverse.linear}, group.room, from, near, far, in);
    }
    const PlacedObject& o = set.frame->objects[set.objects[outer.prim]];
    const Affine3 to_world = set.moving->to_world(o, from.time), back = to_world.inverse();
    return go_in(Inward{to_world.point(group.origin), back.a.data()}, group.room, from, near, far, in);
  }
};

// A ray inside a shared group, and the context in which the group's own acceleration structure is asked.
struct Inside {
  Ray ray;
  Packet packet;
  TraceContext context;

  Inside(const Target& target, const TraceContext& outer, unsigned lane, LocalRay& in) {
    const Ray& from = outer.ray(lane);
    in.id = 0;
    ray = {in.origin + target.group.origin, in.direction, from.time, from.draw};
    packet.ray[0] = 0, packet.advance[0] = 0, packet.size = 1;
    static_cast<RTCIntersectContext&>(context) = outer;
    context.rays = &ray, context.packet = &packet;
    context.world = outer.world, context.moving = outer.moving, context.gathered = outer.gathered;
    if (outer.reach) context.reach = &in.reach;
    context.outer = &outer;
    context.first = outer.first + target.number;
    context.enu = &outer.enu_ray(lane);
    context.start = outer.start + in.enter / outer.stretch;
    context.stretch = outer.stretch * in.stretch;
  }
  // What a hit in the group's acceleration structure is.
  TraceContext::Inside met(const GroupEntry& group, const RTCHit& hit) const {
    const PlacedSet& set = *group.sets[hit.geomID];
    if (set.groups) return context.inside[0];
    const PlacedObject& o = set.frame->objects[set.objects[hit.instID[0]]];
    return {context.first + o.instance, o.mesh};
  }
};

}  // namespace

void intersect_groups(const RTCIntersectFunctionNArguments* args) {
  const auto& set = *static_cast<const PlacedSet*>(args->geometryUserPtr);
  auto* context = static_cast<TraceContext*>(args->context);
  RTCRayN* outer = RTCRayHitN_RayN(args->rayhit, args->N);
  context->set = &set, context->prim = args->primID;
  const Target target = Target::of(set, args->primID);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const unsigned lane = RTCRayN_id(outer, args->N, i);
    LocalRay in;
    if (!target.enter(set, *context, lane, RTCRayN_tnear(outer, args->N, i),
                      context->reach_of(lane, RTCRayN_tfar(outer, args->N, i)), in))
      continue;
    Inside inside(target, *context, lane, in);
    alignas(16) RTCRayHit one;
    load(in, one.ray);
    one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(target.group.handle.scene, &inside.context, &one);
    if (one.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    const double t = in.enter + double{one.ray.tfar} / in.stretch;
    context->inside[lane] = inside.met(target.group, one.hit);
    hand_out(args, i, t - context->packet->advance[lane], one.hit.u, one.hit.v, one.hit.primID);
  }
  context->set = nullptr;
}

void occlude_groups(const RTCOccludedFunctionNArguments* args) {
  const auto& set = *static_cast<const PlacedSet*>(args->geometryUserPtr);
  auto* context = static_cast<TraceContext*>(args->context);
  context->set = &set, context->prim = args->primID;
  const Target target = Target::of(set, args->primID);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const unsigned lane = RTCRayN_id(args->ray, args->N, i);
    LocalRay in;
    if (!target.enter(set, *context, lane, RTCRayN_tnear(args->ray, args->N, i),
                      context->reach_of(lane, RTCRayN_tfar(args->ray, args->N, i)), in))
      continue;
    Inside inside(target, *context, lane, in);
    alignas(16) RTCRay one;
    load(in, one);
    rtcOccluded1(target.group.handle.scene, &inside.context, &one);
    if (one.tfar < 0) RTCRayN_tfar(args->ray, args->N, i) = -INFINITY;
  }
  context->set = nullptr;
}

Box3 World::local_box(const Assembly& frame, size_t object) const {
  if (const uint32_t group = frame.shared_of(object); group != kNone) return groups[group].box;
  const PlacedObject& o = frame.objects[object];
  return o.mesh == kNone ? primitive_box(scene->primitives[o.primitive]) : meshes[o.mesh].box;
}

std::vector<Box3> World::boxes_in(const Assembly& frame, size_t count) const {
  std::vector<Box3> boxes(count);
  parallel_for(0, count, 4096, [&](size_t b, size_t e) {
    for (size_t i = b; i < e; ++i) boxes[i] = transformed(local_box(frame, i), *frame.objects[i].place);
  });
  return boxes;
}

// From the inside out.
void World::measure_groups() {
  for (size_t g = flat.groups.size(); g-- > 0;) {
    GroupEntry& entry = groups[g];
    const SharedGroup& group = flat.groups[g];
    for (const Box3& box : boxes_in(group, group.objects.size())) entry.box.grow(box);
    if (entry.box.empty()) continue;
    entry.origin = entry.box.center();
    const Box3 room{entry.box.low - entry.origin, entry.box.high - entry.origin};
    entry.scale = std::max({room.high.x, room.high.y, room.high.z});
    entry.room = enlarged(room, 2 * entry.slack());
    entry.triangles = triangles_in(group);
  }
}

size_t World::triangles_in(const Assembly& frame) const {
  size_t sum = 0;
  for (size_t i = 0; i < frame.objects.size(); ++i) {
    const uint32_t mesh = frame.objects[i].mesh, group = frame.shared_of(i);
    sum += mesh != kNone ? scene->meshes[mesh].triangle_count() : group != kNone ? groups[group].triangles : 0;
  }
  return sum;
}

// The acceleration structures of what a set places.
void World::build_placed(const PlacedSet& set) const {
  std::vector<uint32_t> ids;
  for (const uint32_t i : set.objects) ids.push_back(set.groups ? set.frame->shared[i] : set.frame->objects[i].mesh);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  parallel_for(0, ids.size(), 1, [&](size_t b, size_t e) {
    const FlushDenormals flush;
    for (size_t i = b; i < e; ++i)
      if (set.groups)
        group_scene(ids[i]);
      else if (ids[i] != kNone)
        mesh_scene(ids[i]);
  });
}

RTCScene World::group_scene(uint32_t index) const {
  GroupEntry& entry = groups[index];
  entry.once.run([&] {
    const SharedGroup& group = flat.groups[index];
    std::vector<uint32_t> members(group.objects.size());
    std::iota(members.begin(), members.end(), 0u);
    const std::vector<Box3> boxes = boxes_in(group, members.size());
    entry.sets = sets_of(group, entry.origin, entry.box, members, boxes);
    entry.handle.scene = new_scene(all_hits);
    for (uint32_t id = 0; id < entry.sets.size(); ++id) {
      PlacedSet& set = *entry.sets[id];
      for (const uint32_t i : set.objects) set.boxes.push_back(enlarged(boxes[i], entry.slack()));
      build_placed(set);
      set.attach(entry.handle.scene, id);
    }
    rtcCommitScene(entry.handle.scene);
    for (const auto& set : entry.sets) std::vector<Box3>().swap(set->boxes);
  });
  return entry.handle.scene;
}

}  // namespace suite
