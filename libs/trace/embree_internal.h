// What the parts of the tracer share: Embree handles, tiles, and the exact surfaces of a tile. Internal.
#pragma once
#include <embree3/rtcore.h>

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "trace/hit_filter.h"
#include "trace/primitive_hit.h"
#include "trace/tile_bvh.h"
#include "trace/tracer.h"

namespace suite {

inline constexpr int kWidth = 8;  // rays in a packet

// One device per process, its instruction set pinned: other sets give other last bits.
RTCDevice device();

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

// The exact surfaces of a tile, for Embree's callbacks. Ids of primitives are positions in `members`.
struct PrimitiveSet {
  struct Member {
    const Primitive* primitive;
    Affine3 to_local;          // ENU -> local
    uint32_t object;           // index into Tracer::objects()
    Box3 bounds;               // ENU
  };
  Vec3 origin;                 // of the tile
  double slack = 0;            // float rounding of bounds, m
  std::vector<Member> members;

  std::optional<LocalHit> meet(unsigned id, Vec3 o, Vec3 d, double t_min, double t_max) const {
    const Member& m = members[id];
    return intersect(*m.primitive, m.to_local.point(origin + o), m.to_local.vector(d), t_min, t_max);
  }
};

void attach_primitives(RTCScene scene, const PrimitiveSet& set, unsigned id);

// Geometry ids inside a tile are positions in `objects`.
struct Tile {
  Vec3 origin;                       // ENU
  Box3 bounds;                       // ENU, a little enlarged
  double scale = 0;                  // largest float coordinate of the tile, m
  std::vector<uint32_t> objects;     // meshes: indices into Tracer::objects()
  std::unique_ptr<PrimitiveSet> primitives;   // exact surfaces, one Embree geometry with the id after the meshes'
  SceneHandle scene;

  // The ray's origin relative to the tile, advanced in double to where it enters the tile's bounds.
  void rebase(const Ray& ray, double enter, float origin_out[3]) const {
    const Vec3 p = ray.origin + ray.direction * enter - origin;
    origin_out[0] = static_cast<float>(p.x), origin_out[1] = static_cast<float>(p.y), origin_out[2] = static_cast<float>(p.z);
  }
};

// Exact surfaces without bounds, tested one by one in double.
struct Unbounded {
  Affine3 to_local;
  uint32_t object;
};

// A ray's way through the tiles, nearest first. Rays that cross more tiles than fit here start again where they stopped.
struct Itinerary {
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
struct Packet {
  uint32_t ray[kWidth];
  double advance[kWidth];
  uint32_t size = 0;
};

struct TracerCore;

// Goes with every query, so that callbacks find the unrounded rays: a ray's id is its place in the packet.
struct FilterContext {
  RTCIntersectContext base;   // first, because Embree hands back its address
  const Tracer* tracer;
  const TracerCore* core;
  const Tile* tile;
  const Packet* packet;
  const Ray* rays;
};
void filter_triangles(const RTCFilterFunctionNArguments* args);

struct TracerCore {
  std::shared_ptr<const HitFilter> filter;
  std::vector<char> may_pass;             // objects with holes; empty without a filter
  std::vector<Tile> tiles;
  std::vector<SceneHandle> mesh_scenes;   // one per mesh that is instanced; empty handles otherwise
  std::vector<uint32_t> tile_of_object;   // kNone for unbounded ones
  std::vector<Unbounded> unbounded;
  TileBvh bvh;

  void finish(const Tracer& t, const Ray& ray, uint32_t object, uint32_t triangle, float u, float v, Hit& hit) const;
  bool keeps(const Tracer& t, const Ray& ray, uint32_t object, uint32_t triangle, double u, double v, Vec3 position, Vec3 normal = {}) const;
  // First hit of an exact surface that the filter does not let through.
  std::optional<LocalHit> meet_kept(const Tracer& t, const Ray& ray, uint32_t object, const Affine3& to_local, double t_min, double t_max) const;
  void finish_exact(const Tracer& t, const Ray& ray, uint32_t object, const Affine3& to_local, double near, Hit& hit) const;
  void trace_packet(const Tracer& t, uint32_t tile, const Packet& packet, std::span<const Ray> rays, std::span<Hit> hits, std::span<double> reach,
                    bool coherent, TraceStatistics& s) const;
  void occlude_packet(const Tracer& t, uint32_t tile, const Packet& packet, std::span<const Ray> rays, std::span<uint8_t> blocked, std::span<double> reach,
                      bool coherent, TraceStatistics& s) const;
  template <class Send>
  void through_tiles(std::span<const Ray> rays, std::span<double> reach, const Send& send) const;
  void meet_unbounded(const Tracer& t, const Ray& ray, double& reach, Hit* hit) const;
  void continue_long_way(Itinerary& way, const Ray& ray, double reach) const;
};

}  // namespace suite
