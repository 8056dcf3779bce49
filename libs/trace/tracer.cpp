#include "trace/tracer.h"

#include <immintrin.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "trace/embree_internal.h"
#include "trace/cell_walk.h"

namespace suite {

namespace {
uint64_t cycles() { return __rdtsc(); }
}  // namespace

// One device per process, its instruction set pinned: other sets give other last bits.
RTCDevice device() {
  static const RTCDevice made = [] {
    RTCDevice d = rtcNewDevice("isa=avx2,threads=0");
    if (!d) throw Error("Embree cannot be started", "a processor with AVX2 is needed");
    rtcSetDeviceErrorFunction(d, [](void*, RTCError code, const char* text) {
      if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
      throw Bug(strf("Embree error %d: %s", static_cast<int>(code), text ? text : ""));
    }, nullptr);
    return d;
  }();
  return made;
}

FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040); }
FlushDenormals::~FlushDenormals() { _mm_setcsr(saved_); }

Tracer::~Tracer() = default;
size_t Tracer::tiles() const { return core_->tiles.size(); }
std::string Tracer::engine() {
  return strf("Embree %d.%d.%d avx2", static_cast<int>(rtcGetDeviceProperty(device(), RTC_DEVICE_PROPERTY_VERSION_MAJOR)),
              static_cast<int>(rtcGetDeviceProperty(device(), RTC_DEVICE_PROPERTY_VERSION_MINOR)),
              static_cast<int>(rtcGetDeviceProperty(device(), RTC_DEVICE_PROPERTY_VERSION_PATCH)));
}

void TracerCore::finish(const Tracer& t, const Ray& ray, uint32_t object, uint32_t triangle, float u, float v, Hit& hit) const {
  const TracedObject& o = t.objects()[object];
  const Mesh& m = t.scene().meshes[o.mesh];
  Vec3 p[3];
  for (int c = 0; c < 3; ++c) {
    const float* f = &m.positions[3 * size_t{m.indices[3 * size_t{triangle} + static_cast<size_t>(c)]}];
    p[c] = Vec3{f[0], f[1], f[2]};
  }
  const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
  hit.position = o.to_world.point(m.origin + p[0] + e1 * double{u} + e2 * double{v});
  hit.normal = normalized(o.to_world.normal(cross(e1, e2)));
  if (o.mirrored) hit.normal = -hit.normal;
  hit.distance = dot(hit.position - ray.origin, ray.direction);
  hit.object = object;
  hit.triangle = triangle;
  hit.u = u;
  hit.v = v;
}

// `near` is where float arithmetic saw the surface; of the exact roots the nearest to it is the one.
void TracerCore::finish_exact(const Tracer& t, const Ray& ray, uint32_t object, const Affine3& to_local, double near, Hit& hit) const {
  const TracedObject& o = t.objects()[object];
  // A root a little before or behind, or none at all at a silhouette: then what float saw stands.
  const double window = 1e-5 * std::fabs(near) + 1e-4 * length(t.bounds().empty() ? Vec3{} : t.bounds().size()) + 1e-9;
  auto found = meet_kept(t, ray, object, to_local, near - window, near + window);
  if (!found || found->t <= 0) found = meet_kept(t, ray, object, to_local, 0, INFINITY);
  if (!found) {
    hit = Hit{};
    return;
  }
  hit.distance = found->t;
  hit.position = ray.origin + ray.direction * found->t;
  hit.normal = normalized(o.to_world.normal(found->normal));
  if (o.mirrored) hit.normal = -hit.normal;
  hit.object = object;
  hit.triangle = 0;
  hit.u = static_cast<float>(found->u), hit.v = static_cast<float>(found->v);
}

void TracerCore::meet_unbounded(const Tracer& t, const Ray& ray, double& reach, Hit* hit) const {
  for (const Unbounded& plane : unbounded) {
    const auto found = meet_kept(t, ray, plane.object, plane.to_local, 0, reach);
    if (!found) continue;
    reach = found->t;
    if (hit) finish_exact(t, ray, plane.object, plane.to_local, reach, *hit);
  }
}

void TracerCore::trace_packet(const Tracer& t, uint32_t tile_index, const Packet& packet, std::span<const Ray> rays, std::span<Hit> hits,
                                std::span<double> reach, bool coherent, TraceStatistics& s) const {
  const Tile& tile = tiles[tile_index];
  FilterContext context{{}, &t, this, &tile, &packet, rays.data()};
  rtcInitIntersectContext(&context.base);
  context.base.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  alignas(32) RTCRayHit8 rh;
  alignas(32) int valid[kWidth];
  for (uint32_t i = 0; i < kWidth; ++i) {
    const uint32_t j = std::min(i, packet.size - 1);
    const Ray& ray = rays[packet.ray[j]];
    valid[i] = i < packet.size ? -1 : 0;
    float origin[3];
    tile.rebase(ray, packet.advance[j], origin);
    rh.ray.org_x[i] = origin[0], rh.ray.org_y[i] = origin[1], rh.ray.org_z[i] = origin[2];
    rh.ray.dir_x[i] = static_cast<float>(ray.direction.x), rh.ray.dir_y[i] = static_cast<float>(ray.direction.y);
    rh.ray.dir_z[i] = static_cast<float>(ray.direction.z);
    rh.ray.tnear[i] = 0, rh.ray.tfar[i] = static_cast<float>(reach[packet.ray[j]] - packet.advance[j]), rh.ray.time[i] = 0;
    rh.ray.mask[i] = 0xffffffffu, rh.ray.id[i] = j, rh.ray.flags[i] = 0;
    rh.hit.geomID[i] = rh.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  const uint64_t start = cycles();
  rtcIntersect8(valid, tile.scene.scene, &context.base, &rh);
  s.cycles += cycles() - start;
  for (uint32_t i = 0; i < packet.size; ++i) {
    if (rh.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    const uint32_t r = packet.ray[i];
    const uint32_t id = rh.hit.instID[0][i] != RTC_INVALID_GEOMETRY_ID ? rh.hit.instID[0][i] : rh.hit.geomID[i];
    reach[r] = packet.advance[i] + static_cast<double>(rh.ray.tfar[i]);
    if (id < tile.objects.size()) {
      finish(t, rays[r], tile.objects[id], rh.hit.primID[i], rh.hit.u[i], rh.hit.v[i], hits[r]);
    } else {
      const PrimitiveSet::Member& m = tile.primitives->members[rh.hit.primID[i]];
      finish_exact(t, rays[r], m.object, m.to_local, reach[r], hits[r]);
    }
  }
}

void TracerCore::occlude_packet(const Tracer& t, uint32_t tile_index, const Packet& packet, std::span<const Ray> rays, std::span<uint8_t> blocked,
                                  std::span<double> reach, bool coherent, TraceStatistics& s) const {
  const Tile& tile = tiles[tile_index];
  FilterContext context{{}, &t, this, &tile, &packet, rays.data()};
  rtcInitIntersectContext(&context.base);
  context.base.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  alignas(32) RTCRay8 q;
  alignas(32) int valid[kWidth];
  for (uint32_t i = 0; i < kWidth; ++i) {
    const uint32_t j = std::min(i, packet.size - 1);
    const Ray& ray = rays[packet.ray[j]];
    valid[i] = i < packet.size ? -1 : 0;
    float origin[3];
    tile.rebase(ray, packet.advance[j], origin);
    q.org_x[i] = origin[0], q.org_y[i] = origin[1], q.org_z[i] = origin[2];
    q.dir_x[i] = static_cast<float>(ray.direction.x), q.dir_y[i] = static_cast<float>(ray.direction.y);
    q.dir_z[i] = static_cast<float>(ray.direction.z);
    q.tnear[i] = 0, q.tfar[i] = static_cast<float>(reach[packet.ray[j]] - packet.advance[j]), q.time[i] = 0;
    q.mask[i] = 0xffffffffu, q.id[i] = j, q.flags[i] = 0;
  }
  const uint64_t start = cycles();
  rtcOccluded8(valid, tile.scene.scene, &context.base, &q);
  s.cycles += cycles() - start;
  for (uint32_t i = 0; i < packet.size; ++i)
    if (q.tfar[i] < 0) {
      blocked[packet.ray[i]] = 1;
      reach[packet.ray[i]] = -1;  // no further tile matters
    }
}

// Sends every ray through its tiles, nearest first, eight rays that are at the same tile at a time.
// send(tile, packet) traces a packet and lowers reach[] of rays that need not go on.
template <class Send>
void TracerCore::through_tiles(std::span<const Ray> rays, std::span<double> reach, const Send& send) const {
  if (tiles.size() == 1) {
    Packet packet;
    for (uint32_t i = 0; i < rays.size(); ++i) {
      double enter = 0, leave = 0;
      if (!clip(tiles[0].bounds, rays[i].origin, inverse_of(rays[i].direction), reach[i], enter, leave)) continue;
      packet.ray[packet.size] = i;
      packet.advance[packet.size] = enter;
      if (++packet.size == kWidth) send(0u, packet), packet.size = 0;
    }
    if (packet.size) send(0u, packet);
    return;
  }
  thread_local std::vector<Itinerary> ways;
  thread_local std::vector<std::pair<uint32_t, uint32_t>> waiting;  // (tile, ray)
  ways.resize(std::max(ways.size(), rays.size()));
  for (uint32_t i = 0; i < rays.size(); ++i) ways[i].plan(bvh, rays[i], reach[i]);
  for (;;) {
    waiting.clear();
    for (uint32_t i = 0; i < rays.size(); ++i) {
      Itinerary& way = ways[i];
      if (way.next == way.count && way.more && reach[i] > 0) continue_long_way(way, rays[i], reach[i]);
      if (way.next < way.count && way.enter[way.next] <= reach[i]) waiting.emplace_back(way.tile[way.next], i);
      else way.next = way.count;
    }
    if (waiting.empty()) return;
    std::stable_sort(waiting.begin(), waiting.end(), [](auto& a, auto& b) { return a.first < b.first; });
    Packet packet;
    for (size_t w = 0; w < waiting.size(); ++w) {
      const auto [tile, i] = waiting[w];
      packet.ray[packet.size] = i;
      packet.advance[packet.size] = ways[i].enter[ways[i].next++];
      ++packet.size;
      if (packet.size == kWidth || w + 1 == waiting.size() || waiting[w + 1].first != tile) send(tile, packet), packet.size = 0;
    }
  }
}

// The next tiles of a ray that crosses more than an itinerary holds: all tiles are listed again and those it has been
// through, which are the nearest, are skipped.
void TracerCore::continue_long_way(Itinerary& way, const Ray& ray, double reach) const {
  const double last = way.enter[way.count - 1];
  std::vector<uint32_t> at_last;  // tiles entered exactly there have been visited
  for (uint32_t i = 0; i < way.count; ++i)
    if (way.enter[i] == last) at_last.push_back(way.tile[i]);
  way.count = way.next = 0;
  way.more = false;
  double t_max = reach;
  bvh.walk(ray, t_max, [&](uint32_t index, double enter) {
    if (enter < last || (enter == last && std::find(at_last.begin(), at_last.end(), index) != at_last.end())) return;
    if (way.count == Itinerary::kRoom) {
      way.more = true;
      t_max = -1;
      return;
    }
    way.tile[way.count] = index;
    way.enter[way.count++] = enter;
  });
}

// reach: how far each ray may go on entry, where it was stopped on return.
void Tracer::nearest_in_tiles(std::span<const Ray> rays, std::span<double> reach, std::span<Hit> hits, bool coherent, TraceStatistics& s) const {
  std::fill(hits.begin(), hits.end(), Hit{});
  s.rays += rays.size();
  for (size_t i = 0; i < rays.size() && !core_->unbounded.empty(); ++i) core_->meet_unbounded(*this, rays[i], reach[i], &hits[i]);
  if (core_->tiles.empty()) return;
  core_->through_tiles(rays, reach, [&](uint32_t tile, const Packet& packet) { core_->trace_packet(*this, tile, packet, rays, hits, reach, coherent, s); });
}

void Tracer::occluded_in_tiles(std::span<const Ray> rays, std::span<double> reach, std::span<uint8_t> blocked, bool coherent, TraceStatistics& s) const {
  std::fill(blocked.begin(), blocked.end(), uint8_t{0});
  s.rays += rays.size();
  for (size_t i = 0; i < rays.size() && !core_->unbounded.empty(); ++i) {
    const double before = reach[i];
    core_->meet_unbounded(*this, rays[i], reach[i], nullptr);
    if (reach[i] < before) blocked[i] = 1, reach[i] = -1;
  }
  if (core_->tiles.empty()) return;
  core_->through_tiles(rays, reach, [&](uint32_t tile, const Packet& packet) { core_->occlude_packet(*this, tile, packet, rays, blocked, reach, coherent, s); });
}

void Tracer::nearest(std::span<const Ray> rays, std::span<Hit> hits, bool coherent, TraceStatistics& s) const {
  thread_local std::vector<double> reach;
  thread_local CellWalk walk;
  if (!periodic_) {
    reach.assign(rays.size(), INFINITY);
    return nearest_in_tiles(rays, reach, hits, coherent, s);
  }
  std::fill(hits.begin(), hits.end(), Hit{});
  walk.start(*periodic_, bounds_, rays, {});
  thread_local std::vector<Hit> found;
  while (walk.next(reach)) {
    found.resize(walk.rays().size());
    nearest_in_tiles(walk.rays(), reach, found, coherent, s);
    for (size_t i = 0; i < found.size(); ++i) {
      if (!found[i].hit()) continue;
      found[i].distance += walk.travelled(i);
      hits[walk.owner(i)] = found[i];
      walk.stop(i);
    }
    walk.advance();
  }
}

void Tracer::occluded(std::span<const Ray> rays, std::span<const double> distance, std::span<uint8_t> blocked, bool coherent,
                      TraceStatistics& s) const {
  thread_local std::vector<double> reach;
  thread_local CellWalk walk;
  if (!periodic_) {
    reach.assign(distance.begin(), distance.end());
    return occluded_in_tiles(rays, reach, blocked, coherent, s);
  }
  std::fill(blocked.begin(), blocked.end(), uint8_t{0});
  walk.start(*periodic_, bounds_, rays, distance);
  thread_local std::vector<uint8_t> found;
  while (walk.next(reach)) {
    found.resize(walk.rays().size());
    occluded_in_tiles(walk.rays(), reach, found, coherent, s);
    for (size_t i = 0; i < found.size(); ++i)
      if (found[i]) blocked[walk.owner(i)] = 1, walk.stop(i);
    walk.advance();
  }
}

Vec3 Tracer::leave(const Hit& hit, Dir direction) const {
  // Positions round to half an ulp of the largest coordinate and Embree's own arithmetic loses a few more. Surfaces
  // without bounds are met in double, where an ulp of the distance travelled is enough.
  const uint32_t index = core_->tile_of_object[hit.object];
  double step = 64 * DBL_EPSILON * (length(hit.position) + hit.distance) + 1e-12;
  if (index != kNone) {
    const Tile& tile = core_->tiles[index];
    const Vec3 local = hit.position - tile.origin;
    step = 8 * FLT_EPSILON * std::max({std::fabs(local.x), std::fabs(local.y), std::fabs(local.z), 1e-3 * tile.scale, 1e-6});
  }
  return hit.position + hit.normal * (dot(direction, hit.normal) >= 0 ? step : -step);
}

}  // namespace suite
