// One packet of rays against one tile, and what becomes of the hits.
#include <immintrin.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <optional>
#include <utility>

#include "trace/embree_internal.h"
#include "trace/primitive_hit.h"

namespace suite {

std::vector<PacketTracer::Found>& PacketTracer::kept() {
  thread_local std::vector<Found> found;
  return found;
}

TraceContext PacketTracer::context(const Packet& packet) const {
  TraceContext c;
  rtcInitIntersectContext(&c);
  c.flags = coherent_ ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  c.rays = rays_.data();
  c.packet = &packet;
  c.world = &world_;
  c.moving = moving_;
  return c;
}

// Lane i of a packet relative to the tile, advanced in double to where it enters its bounds.
RTCRay PacketTracer::float_ray(const Tile& tile, const Packet& packet, uint32_t i) const {
  const uint32_t r = packet.ray[i];
  const Ray& ray = rays_[r];
  const Vec3 p = ray.origin + ray.direction * packet.advance[i] - tile.origin;
  RTCRay q;
  q.org_x = static_cast<float>(p.x), q.org_y = static_cast<float>(p.y), q.org_z = static_cast<float>(p.z);
  q.dir_x = static_cast<float>(ray.direction.x), q.dir_y = static_cast<float>(ray.direction.y);
  q.dir_z = static_cast<float>(ray.direction.z);
  q.tnear = 0, q.tfar = static_cast<float>(reach_[r] - packet.advance[i]);
  q.time = moving_ ? moving_->fraction(ray.time) : 0;
  q.mask = 0xffffffffu, q.id = i, q.flags = 0;
  return q;
}

// All lanes; those beyond the packet repeat its last.
void PacketTracer::load(const Tile& tile, const Packet& packet, RTCRay8& q, int* valid) const {
  for (uint32_t i = 0; i < kWidth; ++i) {
    const RTCRay one = float_ray(tile, packet, std::min(i, packet.size - 1));
    valid[i] = i < packet.size ? -1 : 0;
    q.org_x[i] = one.org_x, q.org_y[i] = one.org_y, q.org_z[i] = one.org_z;
    q.dir_x[i] = one.dir_x, q.dir_y[i] = one.dir_y, q.dir_z[i] = one.dir_z;
    q.tnear[i] = one.tnear, q.tfar[i] = one.tfar, q.time[i] = one.time;
    q.mask[i] = one.mask, q.id[i] = i, q.flags[i] = one.flags;
  }
}

// The corners of a triangle; null for exact surfaces.
const uint32_t* PacketTracer::corners(const Found& found) const {
  return found.mesh == kNone ? nullptr : &world_.scene->meshes[found.mesh].indices[3 * size_t{found.triangle}];
}

void PacketTracer::send(const Tile& tile, const Packet& packet, TraceContext& c, RTCRayHit8& rh) {
  alignas(32) int valid[kWidth];
  load(tile, packet, rh.ray, valid);
  for (uint32_t i = 0; i < kWidth; ++i) rh.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  const uint64_t start = __rdtsc();
  rtcIntersect8(valid, tile.handle.scene, &c, &rh);
  statistics_.cycles += __rdtsc() - start;
}

// Rays that do not run alongside each other soon part among instances, and in crowns of leaves all do: a query for
// eight takes longer there than eight for one. Where few things are placed, and on surfaces that are one mesh, it does
// not.
bool PacketTracer::one_by_one(const Tile& tile) const {
  constexpr size_t kFew = 16;
  if (coherent_ && !(tile.crowns && tile.direct.empty())) return false;
  size_t placed = 0;
  for (const auto& set : tile.sets) placed += set->groups ? kFew + 1 : set->objects.size();
  return placed > kFew;
}

void PacketTracer::nearest(const Tile& tile, const Packet& packet) {
  TraceContext c = context(packet);
  if (one_by_one(tile)) return nearest_one_by_one(tile, packet, c);
  alignas(32) RTCRayHit8 rh;
  send(tile, packet, c, rh);
  for (uint32_t i = 0; i < packet.size; ++i)
    note(tile, packet, i, c, rh.ray.tfar[i], {rh.hit.geomID[i], rh.hit.instID[0][i], rh.hit.primID[i]}, rh.hit.u[i],
         rh.hit.v[i]);
}

void PacketTracer::nearest_one_by_one(const Tile& tile, const Packet& packet, TraceContext& c) {
  alignas(16) RTCRayHit rays[kWidth];
  for (uint32_t i = 0; i < packet.size; ++i) {
    rays[i].ray = float_ray(tile, packet, i);
    rays[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
  }
  const uint64_t start = __rdtsc();
  for (uint32_t i = 0; i < packet.size; ++i) rtcIntersect1(tile.handle.scene, &c, &rays[i]);
  statistics_.cycles += __rdtsc() - start;
  for (uint32_t i = 0; i < packet.size; ++i) {
    const RTCHit& h = rays[i].hit;
    note(tile, packet, i, c, rays[i].ray.tfar, {h.geomID, h.instID[0], h.primID}, h.u, h.v);
  }
}

// What ray i of a packet has met.
void PacketTracer::note(const Tile& tile, const Packet& packet, uint32_t i, const TraceContext& c, float far,
                        const MetIds& met, float u, float v) {
  if (met.geometry == RTC_INVALID_GEOMETRY_ID) return;
  const uint32_t r = packet.ray[i];
  const size_t lone = tile.direct.size();
  reach_[r] = packet.advance[i] + double{far};
  Found& f = found_[r];
  f.tile = &tile;
  f.direct = met.geometry < lone;
  const PlacedSet* set = f.direct ? nullptr : tile.sets[met.geometry - lone].get();
  f.object = f.direct ? tile.direct[met.geometry] : set->objects[met.instance];
  if (set && set->groups)
    f.number = c.inside[i].number, f.mesh = c.inside[i].mesh;
  else
    f.number = world_.flat.number(f.object), f.mesh = world_.flat.objects[f.object].mesh;
  f.triangle = met.primitive;
  f.u = u, f.v = v;
  if (const uint32_t* corner = corners(f)) __builtin_prefetch(corner);
}

void PacketTracer::finish(std::span<Hit> hits) {
  for (const Found& f : found_) {
    if (f.object == kNone) continue;
    const uint32_t* corner = corners(f);
    if (!corner) continue;
    const Mesh& mesh = world_.scene->meshes[f.mesh];
    for (int k = 0; k < 3; ++k) __builtin_prefetch(&mesh.positions[3 * size_t{corner[k]}]);
  }
  // Of the last exact surface at rest: rays beside each other meet the same.
  std::optional<ExactPose> resting;
  uint32_t rests = kNone;
  for (size_t r = 0; r < found_.size(); ++r) {
    const Found& f = found_[r];
    if (f.object == kNone) continue;
    if (f.mesh != kNone) {
      finish_triangle(f, rays_[r], hits[r]);
      continue;
    }
    const PlacedObject& own = world_.flat.objects[f.object];
    if (own.primitive == kNone) {
      const Way& way = world_.flat.way_again(f.number);
      const ExactPose pose(world_.to_world(way, exact_time(rays_[r])));
      finish_exact(f.tile->scale, rays_[r], world_.asked(way), pose, reach_[r], hits[r]);
      continue;
    }
    if (own.node != kNone || std::exchange(rests, f.object) != f.object)
      resting.emplace(world_.to_world(own, exact_time(rays_[r])));
    if (own.node != kNone) rests = kNone;
    finish_exact(f.tile ? f.tile->scale : 0, rays_[r], world_.asked(f.object), *resting, reach_[r], hits[r]);
  }
}

void PacketTracer::all(const Tile& tile, const Packet& packet, std::vector<Hit>& hits) {
  thread_local std::vector<Gathered> gathered;
  gathered.clear();
  TraceContext c = context(packet);
  c.filter = gather_triangles;
  c.gathered = &gathered;
  alignas(32) RTCRayHit8 rh;
  send(tile, packet, c, rh);
  const Ray& ray = rays_[packet.ray[0]];
  for (const Gathered& g : gathered) {
    Hit& hit = hits.emplace_back();
    const uint32_t object = world_.flat.with_number(g.number);
    if (g.exact) {
      const Way way = world_.flat.way_again(g.number);
      place_exact(tile.scale, ray, world_.asked(way), ExactPose(seen_at(way, ray.time)), *g.exact, hit);
    } else {
      const bool direct = std::find(tile.direct.begin(), tile.direct.end(), object) != tile.direct.end();
      const uint32_t mesh = world_.flat.way_again(g.number).object.mesh;
      finish_triangle({&tile, object, g.number, mesh, g.triangle, g.u, g.v, direct}, ray, hit);
    }
  }
}

// Where rays look for an object: at the linear pose of their time.
Affine3 PacketTracer::seen_at(const Way& way, double time) const {
  return way.object.node == kNone ? way.place : moving_->nodes[way.object.node].at(time) * way.place;
}

bool PacketTracer::absent(uint32_t object, const Ray& ray) const {
  const uint32_t node = world_.flat.objects[object].node;
  return node != kNone && moving_->nodes[node].partly && !moving_->there(object, ray.time);
}

void PacketTracer::all_unbounded(uint32_t object, std::vector<Hit>& hits) {
  const Ray& ray = rays_[0];
  if (absent(object, ray)) return;
  const Way way = world_.flat.way(object);
  const Asked asked = world_.asked(object);
  const ExactPose pose(seen_at(way, ray.time));
  for (auto found = world_.meet(ray, asked, pose, 0, 0, reach_[0]); found;
       found = world_.meet(ray, asked, pose, 0, World::again(found->t), reach_[0]))
    place_exact(0, ray, asked, pose, *found, hits.emplace_back());
}

void PacketTracer::occluded(const Tile& tile, const Packet& packet, std::span<uint8_t> blocked) {
  TraceContext c = context(packet);
  c.reach = reach_.data();
  const auto answer = [&](uint32_t i, float far) {
    if (!(far < 0)) return;
    blocked[packet.ray[i]] = 1;
    reach_[packet.ray[i]] = -1;  // no further tile matters
  };
  if (one_by_one(tile)) {
    alignas(16) RTCRay rays[kWidth];
    for (uint32_t i = 0; i < packet.size; ++i) rays[i] = float_ray(tile, packet, i);
    const uint64_t start = __rdtsc();
    for (uint32_t i = 0; i < packet.size; ++i) rtcOccluded1(tile.handle.scene, &c, &rays[i]);
    statistics_.cycles += __rdtsc() - start;
    for (uint32_t i = 0; i < packet.size; ++i) answer(i, rays[i].tfar);
    return;
  }
  alignas(32) RTCRay8 q;
  alignas(32) int valid[kWidth];
  load(tile, packet, q, valid);
  const uint64_t start = __rdtsc();
  rtcOccluded8(valid, tile.handle.scene, &c, &q);
  statistics_.cycles += __rdtsc() - start;
  for (uint32_t i = 0; i < packet.size; ++i) answer(i, q.tfar[i]);
}

// Where hits are put: inside the window.
double PacketTracer::exact_time(const Ray& ray) const {
  return moving_ ? std::clamp(ray.time, moving_->window.begin, moving_->window.end) : 0;
}

// How far off a surface rays must start for what moving geometry is seen aside from its place by, m.
static double aside(const MovingPart* moving, const TracedObject& o) {
  return o.node == kNone ? 0 : 2 * moving->nodes[o.node].bound;
}

void PacketTracer::finish_triangle(const Found& found, const Ray& ray, Hit& hit) const {
  const auto& [tile, object, number, mesh, triangle, u, v, direct] = found;
  const PlacedObject& o = world_.flat.objects[object];  // or the placement of the group that holds it: the same node
  const Mesh& m = world_.scene->meshes[mesh];
  const uint32_t* corner = corners(found);
  const auto vertex = [&](uint32_t c) {
    const float* f = &m.positions[3 * size_t{corner[c]}];
    return Vec3{f[0], f[1], f[2]};
  };
  const Vec3 p0 = vertex(0), e1 = vertex(1) - p0, e2 = vertex(2) - p0, within = e1 * double{u} + e2 * double{v};
  const Vec3 p = p0 + within, across = cross(e1, e2);
  // The way from a corner is rounded, too, when a ray begins at the hit.
  // (std::max: fmax is a call.)
  const Vec3 most{std::max(std::fabs(p.x), std::fabs(within.x)), std::max(std::fabs(p.y), std::fabs(within.y)),
                  std::max(std::fabs(p.z), std::fabs(within.z))};
  double reach = 0;  // largest coordinate that was rounded to float on the way to this hit, m
  double span = 0;   // across the frame in which coordinates are
  if (direct) {
    // A translation only.
    hit.position = p + tile->origin;
    hit.normal = normalized(across);
    reach = std::max({most.x, most.y, most.z, 1e-3 * tile->scale, 1e-6});
    span = 2 * tile->scale;
  } else {
    const Affine3 to_world = o.mesh != kNone ? world_.to_world(o, exact_time(ray))
                                             : world_.to_world(world_.flat.way_again(number), exact_time(ray));
    hit.position = to_world.point(m.origin + p);
    hit.normal = normalized(to_world.normal(across));
    // The winding turns round under a mirror; the front side stays the front side.
    if (to_world.determinant() < 0) hit.normal = -hit.normal;
    const double floor = 1e-3 * world_.meshes[mesh].scale;
    const Vec3 q{std::max(most.x, floor), std::max(most.y, floor), std::max(most.z, floor)};
    for (size_t k = 0; k < 9; k += 3) {
      const double x = std::fabs(to_world.a[k]), y = std::fabs(to_world.a[k + 1]), z = std::fabs(to_world.a[k + 2]);
      reach = std::max(reach, x * q.x + y * q.y + z * q.z);
      span = std::max(span, x + y + z);
    }
    span *= 2 * world_.meshes[mesh].scale;
  }
  // Of the double coordinates in the scene's frame, too (their sum bounds the length without a root).
  const Vec3& q = hit.position;
  const double far = std::fabs(q.x) + std::fabs(q.y) + std::fabs(q.z);
  hit.step = static_cast<float>(8 * FLT_EPSILON * reach + 1e-15 * far + aside(moving_, o));
  hit.span = static_cast<float>(span);
  hit.distance = dot(hit.position - ray.origin, ray.direction);
  hit.time = ray.time;
  hit.object = number;
  hit.triangle = triangle;
  hit.u = u;
  hit.v = v;
}

// `near` is where float arithmetic saw the surface; of the exact roots the nearest to it is the one. scale: of the
// tile.
void PacketTracer::finish_exact(double scale, const Ray& ray, const Asked& asked, const ExactPose& pose, double near,
                                Hit& hit) const {
  // A root a little before or behind, or none at all at a silhouette: then what float saw stands.
  const double window = 1e-5 * std::fabs(near) + 2e-4 * scale + 1e-9 + 4 * aside(moving_, asked.object);
  auto found = world_.meet(ray, asked, pose, 0, near - window, near + window);
  if (!found || found->t <= 0) found = world_.meet(ray, asked, pose, 0, 0, INFINITY);
  if (!found) {
    hit = Hit{};
    return;
  }
  place_exact(scale, ray, asked, pose, *found, hit);
}

void PacketTracer::place_exact(double scale, const Ray& ray, const Asked& asked, const ExactPose& pose,
                               const LocalHit& found, Hit& hit) const {
  hit.distance = found.t;
  hit.position = ray.origin + ray.direction * found.t;
  hit.normal = normalized(pose.to_world.normal(found.normal));
  if (pose.mirrored) hit.normal = -hit.normal;
  // Surfaces without bounds are met in double, where an ulp of the distance travelled is enough.
  const double step = scale > 0 ? 8 * FLT_EPSILON * scale + 8 * DBL_EPSILON * hit.distance
                                : 64 * DBL_EPSILON * (length(hit.position) + hit.distance) + 1e-12;
  hit.step = static_cast<float>(step + aside(moving_, asked.object));
  hit.span = 0;
  hit.time = ray.time;
  hit.object = asked.number;
  hit.triangle = 0;
  hit.u = static_cast<float>(found.u), hit.v = static_cast<float>(found.v);
}

void PacketTracer::unbounded(uint32_t object, std::span<uint8_t> blocked) {
  const Way way = world_.flat.way(object);
  const Asked asked = world_.asked(object);
  const bool plain = !asked.may_pass && way.object.node == kNone;
  const Affine3 to_local = way.place.inverse();
  for (uint32_t r = 0; r < rays_.size(); ++r) {
    const Ray& ray = rays_[r];
    double t = INFINITY;
    if (plain)
      t = distance_to(world_.scene->primitives[way.object.primitive], to_local.point(ray.origin),
                      to_local.vector(ray.direction), 0, reach_[r]);
    else if (!absent(object, ray))
      if (const auto found = world_.meet(ray, asked, ExactPose(seen_at(way, ray.time)), 0, 0, reach_[r])) t = found->t;
    if (!(t < reach_[r])) continue;
    reach_[r] = blocked.empty() ? t : -1;
    if (blocked.empty())
      found_[r] = {nullptr, object, way.number, kNone, 0, 0, 0, false};
    else
      blocked[r] = 1;
  }
}

}  // namespace suite
