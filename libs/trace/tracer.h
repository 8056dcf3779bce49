// A scene frozen in a time window, ready to be asked for nearest hits and visibility.
//
// Geometry lives in tiles: groups of objects within a few kilometres, each an Embree scene in float metres around its own
// double origin. Rays are double; they are advanced to a tile's bounds and re-based before they become float, and hits
// are rebuilt in double from barycentrics, so precision does not depend on where sensor or scene are.
//
// Based on: Goodenough & Brown, section III-A-1 (Embree, instancing of any depth); I. Wald et al., "Embree: a kernel
// framework for efficient CPU ray tracing", 2014. Debian's Embree has one instance level, so nested placements are
// flattened here with transforms composed in double.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "math/vec.h"
#include "scene/scene.h"

namespace suite {

// One flattened instance of a mesh or of an exact surface.
struct TracedObject {
  Affine3 to_world;                 // mesh local (double, mesh origin included) -> ENU
  uint32_t mesh = kNone;            // index into Scene::meshes, or kNone
  uint32_t primitive = kNone;       // index into Scene::primitives, or kNone
  uint32_t material_override = kNone;
  uint32_t tag = kNone;             // nearest tag on the way down from the root
  bool mirrored = false;            // to_world turns the winding round; the front side stays the front side
  uint32_t instance = kNone;        // number of the flattened instance, in the order of the hierarchy
};

struct Hit {
  double distance = 0;              // m from the ray's origin
  Vec3 position;                    // ENU, rebuilt from barycentrics in double
  Dir normal;                       // geometric, unit, on the front side (counter-clockwise vertices), ENU
  uint32_t object = kNone;          // index into Tracer::objects(); kNone = nothing was hit
  uint32_t triangle = 0;            // in the mesh
  float u = 0, v = 0;               // barycentrics of vertices 1 and 2; of an exact surface its UV
  bool hit() const { return object != kNone; }
};

struct TraceStatistics {
  uint64_t rays = 0;                // nearest + visibility
  uint64_t cycles = 0;              // time-stamp counter cycles spent inside Embree
};

// A scene that repeats itself in both horizontal directions: what leaves the cell on one side comes in on the other.
struct Periodic {
  Vec2 low, size;                   // the cell, m ENU; size > 0
};

struct TracerCore;
class HitFilter;

class Tracer {
 public:
  // Builds acceleration structures in parallel. The scene must have passed check_scene and outlive nothing: it is kept.
  // periodic: objects that stick out of the cell come in again on its other side; positions of hits lie in the cell.
  // filter: decides about holes in surfaces (hit_filter.h); null = there are none.
  explicit Tracer(std::shared_ptr<const Scene> scene, std::optional<Periodic> periodic = std::nullopt,
                  std::shared_ptr<const HitFilter> filter = nullptr);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  // Nearest hits of n rays, all the way to infinity. coherent: neighbours in the list run alongside each other.
  void nearest(std::span<const Ray> rays, std::span<Hit> hits, bool coherent, TraceStatistics& statistics) const;
  // blocked[i] = 1 when something lies on ray i between its origin and distance[i] (infinity allowed), else 0.
  void occluded(std::span<const Ray> rays, std::span<const double> distance, std::span<uint8_t> blocked, bool coherent,
                TraceStatistics& statistics) const;

  // Where a ray that leaves `hit` to the side of `direction` must start so as not to meet the same surface again: a few
  // units of the last float place of the tile's size off the surface, along the geometric normal.
  Vec3 leave(const Hit& hit, Dir direction) const;

  const Scene& scene() const { return *scene_; }
  std::span<const TracedObject> objects() const { return objects_; }
  const Box3& bounds() const { return bounds_; }
  size_t triangles() const { return triangles_; }      // instanced ones counted each time
  size_t tiles() const;
  // Name and instruction set of the ray tracer, for result headers: "Embree 3.13.5 avx2".
  static std::string engine();

 private:
  std::shared_ptr<const Scene> scene_;
  void nearest_in_tiles(std::span<const Ray> rays, std::span<double> reach, std::span<Hit> hits, bool coherent, TraceStatistics& statistics) const;
  void occluded_in_tiles(std::span<const Ray> rays, std::span<double> reach, std::span<uint8_t> blocked, bool coherent, TraceStatistics& statistics) const;
  std::optional<Periodic> periodic_;
  std::vector<TracedObject> objects_;
  Box3 bounds_;
  size_t triangles_ = 0;
  std::unique_ptr<TracerCore> core_;
};

// Makes denormals zero in this thread for as long as it lives; every thread that traces holds one (Embree requires it).
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();

 private:
  unsigned saved_;
};

}  // namespace suite
