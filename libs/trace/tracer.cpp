#include "trace/tracer.h"

#include <embree3/rtcore.h>
#include <immintrin.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "trace/flatten.h"
#include "trace/tile_bvh.h"

namespace suite {

namespace {

constexpr double kTileSize = 2048;      // m: float positions inside are good to 0.1 mm
constexpr int kWidth = 8;

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

uint64_t cycles() { return __rdtsc(); }

struct SceneHandle {
  RTCScene scene = nullptr;
  SceneHandle() = default;
  SceneHandle(SceneHandle&& o) noexcept : scene(std::exchange(o.scene, nullptr)) {}
  SceneHandle& operator=(SceneHandle&& o) noexcept {
    std::swap(scene, o.scene);
    return *this;
  }
  ~SceneHandle() {
    if (scene) rtcReleaseScene(scene);
  }
};

RTCScene new_scene() {
  RTCScene s = rtcNewScene(device());
  rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_HIGH);
  return s;
}

// Shares the scene's arrays with Embree; the pad float behind the vertices allows its 16-byte loads.
void attach_mesh(RTCScene scene, const Mesh& mesh, unsigned id) {
  RTCGeometry g = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0, 12, mesh.vertex_count());
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0, 12, mesh.triangle_count());
  rtcSetGeometryBuildQuality(g, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(scene, g, id);
  rtcReleaseGeometry(g);
}

void attach_instance(RTCScene scene, RTCScene mesh_scene, const Affine3& map, unsigned id) {
  RTCGeometry g = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(g, mesh_scene);
  float m[12];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) m[4 * r + c] = static_cast<float>(map.a[3 * r + c]);
  m[3] = static_cast<float>(map.b.x), m[7] = static_cast<float>(map.b.y), m[11] = static_cast<float>(map.b.z);
  rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, m);
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(scene, g, id);
  rtcReleaseGeometry(g);
}

bool pure_translation(const Affine3& m) { return m.a == Affine3{}.a; }

}  // namespace

FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040); }
FlushDenormals::~FlushDenormals() { _mm_setcsr(saved_); }

// Geometry ids inside a tile are positions in `objects`.
struct Tracer::Tile {
  Vec3 origin;                       // ENU
  Box3 bounds;                       // ENU, a little enlarged
  double scale = 0;                  // largest float coordinate of the tile, m
  std::vector<uint32_t> objects;     // indices into Tracer::objects_
  SceneHandle scene;

  // The ray's origin relative to the tile, advanced in double to where it enters the tile's bounds.
  void rebase(const Ray& ray, double enter, float origin_out[3]) const {
    const Vec3 p = ray.origin + ray.direction * enter - origin;
    origin_out[0] = static_cast<float>(p.x), origin_out[1] = static_cast<float>(p.y), origin_out[2] = static_cast<float>(p.z);
  }
};

struct Tracer::Impl {
  std::vector<Tile> tiles;
  std::vector<SceneHandle> mesh_scenes;   // one per mesh that is instanced; empty handles otherwise
  std::vector<uint32_t> tile_of_object;
  TileBvh bvh;

  void finish(const Tracer& t, const Ray& ray, uint32_t object, uint32_t triangle, float u, float v, Hit& hit) const;
  void trace_packet(const Tracer& t, uint32_t tile, const Packet& packet, std::span<const Ray> rays, std::span<Hit> hits, std::span<double> reach,
                    bool coherent, TraceStatistics& s) const;
  void occlude_packet(uint32_t tile, const Packet& packet, std::span<const Ray> rays, std::span<uint8_t> blocked, std::span<double> reach,
                      bool coherent, TraceStatistics& s) const;
  template <class Send>
  void through_tiles(std::span<const Ray> rays, std::span<double> reach, const Send& send) const;
  void continue_long_way(Itinerary& way, const Ray& ray, double reach) const;
};

Tracer::Tracer(std::shared_ptr<const Scene> scene) : scene_(std::move(scene)), objects_(flatten(*scene_)), impl_(new Impl) {
  const FlushDenormals flush;
  const Scene& s = *scene_;
  std::vector<Box3> mesh_boxes(s.meshes.size());
  parallel_for(0, s.meshes.size(), 1, [&](size_t b, size_t e) {
    for (size_t i = b; i < e; ++i) mesh_boxes[i] = local_bounds(s.meshes[i]);
  });
  std::vector<uint32_t> uses(s.meshes.size(), 0);
  std::erase_if(objects_, [&](const TracedObject& o) { return s.meshes[o.mesh].triangle_count() == 0; });
  for (const TracedObject& o : objects_) ++uses[o.mesh];

  // Group objects into tiles: one for a scene of a few kilometres, a grid by centres otherwise; what is larger than a
  // cell gets a tile of its own.
  std::vector<Box3> boxes(objects_.size());
  parallel_for(0, objects_.size(), 4096, [&](size_t b, size_t e) {
    for (size_t i = b; i < e; ++i) boxes[i] = transformed(mesh_boxes[objects_[i].mesh], objects_[i].to_world);
  });
  for (size_t i = 0; i < objects_.size(); ++i) bounds_.grow(boxes[i]), triangles_ += s.meshes[objects_[i].mesh].triangle_count();
  const Vec3 extent = bounds_.empty() ? Vec3{} : bounds_.size();
  const bool single = std::max({extent.x, extent.y, extent.z}) <= 2 * kTileSize;
  std::map<std::tuple<long, long, long, long>, std::vector<uint32_t>> cells;
  for (uint32_t i = 0; i < objects_.size(); ++i) {
    const Vec3 c = boxes[i].center(), size = boxes[i].size();
    const bool large = std::max({size.x, size.y, size.z}) > 2 * kTileSize;
    if (single) cells[{0, 0, 0, 0}].push_back(i);
    else if (large) cells[{0, 0, 0, 1 + static_cast<long>(i)}].push_back(i);
    else cells[{std::lround(c.x / kTileSize), std::lround(c.y / kTileSize), std::lround(c.z / kTileSize), 0}].push_back(i);
  }

  // The largest unrotated, once-used mesh of a tile gives it its origin and is attached without an instance.
  impl_->tile_of_object.assign(objects_.size(), 0);
  impl_->mesh_scenes.resize(s.meshes.size());
  std::vector<char> needs_scene(s.meshes.size(), 0), direct(objects_.size(), 0);
  for (auto& [key, members] : cells) {
    Tile& tile = impl_->tiles.emplace_back();
    tile.objects = std::move(members);
    size_t most = 0;
    for (const uint32_t i : tile.objects) {
      tile.bounds.grow(boxes[i]);
      impl_->tile_of_object[i] = static_cast<uint32_t>(impl_->tiles.size() - 1);
    }
    tile.origin = tile.bounds.center();
    for (const uint32_t i : tile.objects) {
      const Mesh& mesh = s.meshes[objects_[i].mesh];
      if (!pure_translation(objects_[i].to_world) || uses[objects_[i].mesh] > 1 || mesh.triangle_count() <= most) continue;
      const Vec3 candidate = objects_[i].to_world.b + mesh.origin;
      if (length(candidate - tile.bounds.center()) > length(tile.bounds.size()) + kTileSize) continue;
      most = mesh.triangle_count();
      tile.origin = candidate;
    }
    for (const uint32_t i : tile.objects) {
      const Mesh& mesh = s.meshes[objects_[i].mesh];
      direct[i] = pure_translation(objects_[i].to_world) && uses[objects_[i].mesh] == 1 && objects_[i].to_world.b + mesh.origin == tile.origin;
      if (!direct[i]) needs_scene[objects_[i].mesh] = 1;
    }
    const Vec3 far_low = tile.bounds.low - tile.origin, far_high = tile.bounds.high - tile.origin;
    for (int a = 0; a < 3; ++a) tile.scale = std::max({tile.scale, std::fabs(far_low[a]), std::fabs(far_high[a])});
    // Float rounding may move geometry out of the exact bounds by some ulp.
    const double slack = 16 * FLT_EPSILON * tile.scale + 1e-9;
    tile.bounds.low -= {slack, slack, slack};
    tile.bounds.high += {slack, slack, slack};
  }
  for (size_t m = 0; m < s.meshes.size(); ++m)
    if (needs_scene[m]) {
      impl_->mesh_scenes[m].scene = new_scene();
      attach_mesh(impl_->mesh_scenes[m].scene, s.meshes[m], 0);
      rtcCommitScene(impl_->mesh_scenes[m].scene);
    }
  std::vector<Box3> tile_boxes;
  for (Tile& tile : impl_->tiles) {
    tile.scene.scene = new_scene();
    for (uint32_t id = 0; id < tile.objects.size(); ++id) {
      const TracedObject& o = objects_[tile.objects[id]];
      if (direct[tile.objects[id]]) attach_mesh(tile.scene.scene, s.meshes[o.mesh], id);
      else attach_instance(tile.scene.scene, impl_->mesh_scenes[o.mesh].scene,
                           translation(-tile.origin) * o.to_world * translation(s.meshes[o.mesh].origin), id);
    }
    rtcCommitScene(tile.scene.scene);
    tile_boxes.push_back(tile.bounds);
  }
  impl_->bvh.build(tile_boxes);
}

Tracer::~Tracer() = default;
size_t Tracer::tiles() const { return impl_->tiles.size(); }
std::string Tracer::engine() {
  return strf("Embree %d.%d.%d avx2", static_cast<int>(rtcGetDeviceProperty(device(), RTC_DEVICE_PROPERTY_VERSION_MAJOR)),
              static_cast<int>(rtcGetDeviceProperty(device(), RTC_DEVICE_PROPERTY_VERSION_MINOR)),
              static_cast<int>(rtcGetDeviceProperty(device(), RTC_DEVICE_PROPERTY_VERSION_PATCH)));
}

void Tracer::Impl::finish(const Tracer& t, const Ray& ray, uint32_t object, uint32_t triangle, float u, float v, Hit& hit) const {
  const TracedObject& o = t.objects_[object];
  const Mesh& m = t.scene_->meshes[o.mesh];
  Vec3 p[3];
  for (int c = 0; c < 3; ++c) {
    const float* f = &m.positions[3 * size_t{m.indices[3 * size_t{triangle} + static_cast<size_t>(c)]}];
    p[c] = Vec3{f[0], f[1], f[2]};
  }
  const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
  hit.position = o.to_world.point(m.origin + p[0] + e1 * double{u} + e2 * double{v});
  hit.normal = normalized(o.to_world.normal(cross(e1, e2)));
  hit.distance = dot(hit.position - ray.origin, ray.direction);
  hit.object = object;
  hit.triangle = triangle;
  hit.u = u;
  hit.v = v;
}

// A ray's way through the tiles, nearest first. Rays that cross more tiles than fit here start again where they stopped.
struct Tracer::Itinerary {
  static constexpr uint32_t kRoom = 12;
  uint32_t tile[kRoom];
  double enter[kRoom];
  uint32_t count = 0, next = 0;
  bool more = false;

  void plan(const TileBvh& bvh, const Ray& ray, double t_max) {
    count = next = 0;
    more = false;
    bvh.walk(ray, t_max, [&](uint32_t index, double at) {
      if (count == kRoom) {
        more = true;
        t_max = -1;
        return;
      }
      tile[count] = index;
      enter[count++] = at;
    });
  }
};

// Eight rays of a list against one tile.
struct Tracer::Packet {
  uint32_t ray[kWidth];
  double advance[kWidth];
  uint32_t size = 0;
};

void Tracer::Impl::trace_packet(const Tracer& t, uint32_t tile_index, const Packet& packet, std::span<const Ray> rays, std::span<Hit> hits,
                                std::span<double> reach, bool coherent, TraceStatistics& s) const {
  const Tile& tile = tiles[tile_index];
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
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
    rh.ray.mask[i] = 0xffffffffu, rh.ray.id[i] = 0, rh.ray.flags[i] = 0;
    rh.hit.geomID[i] = rh.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  const uint64_t start = cycles();
  rtcIntersect8(valid, tile.scene.scene, &context, &rh);
  s.cycles += cycles() - start;
  for (uint32_t i = 0; i < packet.size; ++i) {
    if (rh.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    const uint32_t r = packet.ray[i];
    const uint32_t id = rh.hit.instID[0][i] != RTC_INVALID_GEOMETRY_ID ? rh.hit.instID[0][i] : rh.hit.geomID[i];
    reach[r] = packet.advance[i] + static_cast<double>(rh.ray.tfar[i]);
    finish(t, rays[r], tile.objects[id], rh.hit.primID[i], rh.hit.u[i], rh.hit.v[i], hits[r]);
  }
}

void Tracer::Impl::occlude_packet(uint32_t tile_index, const Packet& packet, std::span<const Ray> rays, std::span<uint8_t> blocked,
                                  std::span<double> reach, bool coherent, TraceStatistics& s) const {
  const Tile& tile = tiles[tile_index];
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
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
    q.mask[i] = 0xffffffffu, q.id[i] = 0, q.flags[i] = 0;
  }
  const uint64_t start = cycles();
  rtcOccluded8(valid, tile.scene.scene, &context, &q);
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
void Tracer::Impl::through_tiles(std::span<const Ray> rays, std::span<double> reach, const Send& send) const {
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
void Tracer::Impl::continue_long_way(Itinerary& way, const Ray& ray, double reach) const {
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

void Tracer::nearest(std::span<const Ray> rays, std::span<Hit> hits, bool coherent, TraceStatistics& s) const {
  thread_local std::vector<double> reach;
  reach.assign(rays.size(), INFINITY);
  std::fill(hits.begin(), hits.end(), Hit{});
  s.rays += rays.size();
  if (impl_->tiles.empty()) return;
  impl_->through_tiles(rays, reach, [&](uint32_t tile, const Packet& packet) { impl_->trace_packet(*this, tile, packet, rays, hits, reach, coherent, s); });
}

void Tracer::occluded(std::span<const Ray> rays, std::span<const double> distance, std::span<uint8_t> blocked, bool coherent,
                      TraceStatistics& s) const {
  thread_local std::vector<double> reach;
  reach.assign(distance.begin(), distance.end());
  std::fill(blocked.begin(), blocked.end(), uint8_t{0});
  s.rays += rays.size();
  if (impl_->tiles.empty()) return;
  impl_->through_tiles(rays, reach, [&](uint32_t tile, const Packet& packet) { impl_->occlude_packet(tile, packet, rays, blocked, reach, coherent, s); });
}

Vec3 Tracer::leave(const Hit& hit, Dir direction) const {
  const Tile& tile = impl_->tiles[impl_->tile_of_object[hit.object]];
  // Positions round to half an ulp of the largest coordinate and Embree's own arithmetic loses a few more.
  const Vec3 local = hit.position - tile.origin;
  const double reach = std::max({std::fabs(local.x), std::fabs(local.y), std::fabs(local.z), 1e-3 * tile.scale, 1e-6});
  const double step = 8 * FLT_EPSILON * reach;
  return hit.position + hit.normal * (dot(direction, hit.normal) >= 0 ? step : -step);
}

}  // namespace suite
