// A scene frozen in a time window, ready to be asked for nearest hits and visibility.
//
// Geometry lives in tiles: groups of objects within a few kilometres, each an Embree scene in float metres around its
// own double origin. Rays are double; they are advanced to a tile's bounds and re-based before they become float.
// Instances take the unrounded ray into their own frame in double, so what is inside one is as precise as its own size,
// wherever it stands and however it moves. Hits are rebuilt in double from barycentrics.
//
// What moves has exact poses at the keys of its window and linear ones between them, keys as close as motion_bound
// asks; hits are rebuilt with the exact pose (screw motion) at the time of the ray. What is not there all through a
// window is left out of it, and what comes, goes or changes its material within it is met by the rays of those times
// only.
//
// Based on: Goodenough & Brown, section III-A-1 (Embree, instancing of any depth); I. Wald et al., "Embree: a kernel
// framework for efficient CPU ray tracing", 2014. Debian's Embree has one instance level, so nested placements are
// flattened here with transforms composed in double. Where that would be too many, groups that are placed often are
// kept once (scene/unfolded.h), and rays go from frame to frame in double: memory is the sum of the levels, not their
// product.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "math/vec.h"
#include "motion/time_span.h"
#include "scene/scene.h"
#include "scene/unfolded.h"

namespace suite {

// One instance of a mesh or of an exact surface.
struct TracedObject {
  uint32_t mesh = kNone;       // index into Scene::meshes, or kNone
  uint32_t primitive = kNone;  // index into Scene::primitives, or kNone
  uint32_t material_override = kNone;
  uint32_t tag = kNone;  // nearest tag on the way down from the root
  uint32_t instance =
      kNone;              // number of the flattened instance, in the order of the hierarchy; one for all its materials
  uint32_t node = kNone;  // the frame it belongs to that moves, comes or goes; kNone = always at rest
};

// An object with its transform.
struct PlacedObject : TracedObject {
  const Affine3* place = nullptr;  // local (double, mesh origin included) -> ENU, or the axes of the moving node
};

struct Hit {
  double distance = 0;      // m from the ray's origin
  Vec3 position;            // ENU, rebuilt from barycentrics in double
  Dir normal;               // geometric, unit, on the front side (counter-clockwise vertices), ENU
  double time = 0;          // s, of the ray
  uint32_t object = kNone;  // number of the object, as Tracer::object() has it; kNone = nothing was hit
  uint32_t triangle = 0;    // in the mesh
  float u = 0, v = 0;       // barycentrics of vertices 1 and 2; of an exact surface its UV
  float step = 0;           // m, how far rays that leave the surface must start off it
  float span = 0;           // m, over which rays that come to it are rounded to float; 0: the step covers it
  bool hit() const { return object != kNone; }
};

struct TraceStatistics {
  uint64_t rays = 0;    // nearest + visibility
  uint64_t cycles = 0;  // time-stamp counter cycles spent inside Embree
};

// A scene that repeats itself in both horizontal directions: what leaves the cell on one side comes in on the other.
struct Periodic {
  Vec2 low, size;  // the cell, m ENU; size > 0
};

// How far (m) what moves may be from its true place while rays look for it: 1e-5 of its extent, at most 0.1 mm. Hits
// that are found are then put on the exact place.
double motion_bound(double radius);

// How much tiles may take at once: acceleration structures, and the arrays of the meshes that they stand on.
struct TileLimit {
  uint64_t bytes = 0;                                 // 0 = no limit
  std::function<void(const std::string&)> warn = {};  // is told, once, of a tile that is larger by itself; may be empty
};

// What tiles took under a limit.
struct TileUse {
  uint64_t built = 0, dropped = 0;                  // tiles, each time counted
  uint64_t most_tiles = 0;                          // at once
  uint64_t most_structures = 0, most_geometry = 0;  // bytes at once
};

// What tiles will take, before any is built; some 30 % too much, as space is set aside for it.
struct TileForecast {
  size_t tiles = 0;
  uint64_t structures = 0, geometry = 0;  // bytes of all tiles
  uint64_t largest = 0;                   // bytes of both of the largest tile
};

class HitFilter;
class TileHull;
struct World;  // what is at rest, shared by the tracers of all windows
struct MovingPart;

class Tracer {
 public:
  // Builds acceleration structures in parallel; scenes of many tiles build each one when a ray first comes there. The
  // scene must have passed check_scene and is kept. Rays have times inside the window (others see its nearest end).
  // periodic: objects that stick out of the cell come in again on its other side; positions of hits lie in the cell.
  // limit: tiles are built when a ray comes, and those given up that none came to for longest; hits are the same.
  // filter: decides about holes in surfaces (hit_filter.h); null = there are none.
  // Surfaces without bounds are not repeated but met by the whole ray.
  // keep: how many placements are kept before groups are shared, as share_groups has it; results do not depend on it
  // but for the numbers of objects.
  // Error: a motion that does not cover the window while what moves is there; things that move, come or go, or a plane
  // that is not level, in a periodic scene.
  explicit Tracer(std::shared_ptr<const Scene> scene, std::optional<Periodic> periodic = std::nullopt,
                  TimeSpan window = {}, std::shared_ptr<const HitFilter> filter = nullptr, const TileLimit& limit = {},
                  double keep = kUnfoldedAtMost);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  // Nearest hits of n rays, all the way to infinity. coherent: neighbours in the list run alongside each other.
  void nearest(std::span<const Ray> rays, std::span<Hit> hits, bool coherent, TraceStatistics& statistics) const;
  // blocked[i] = 1 when something lies on ray i between its origin and distance[i] (infinity allowed), else 0.
  void occluded(std::span<const Ray> rays, std::span<const double> distance, std::span<uint8_t> blocked, bool coherent,
                TraceStatistics& statistics) const;

  // Everything that a short ray meets within `length` (m, finite), nearest first, surfaces that lie in each other and
  // both triangles of an edge included; what has holes as nearest() sees it. Distances are measured as those of
  // nearest(). Replaces the contents of hits.
  void all(const Ray& ray, double length, std::vector<Hit>& hits, TraceStatistics& statistics) const;

  // Whether all() may be asked: some surface bounds a medium or has an index of refraction.
  bool tells_all() const;

  // The surfaces that a place lies on: those that it is closer to than a quarter of what rays start off them. Time and
  // draw are those of `at`, its direction is not asked. Hits, with distance: m that the place lies in front of the
  // surface. Of surfaces that lie in each other one may be left out. Replaces the contents of hits.
  void touching(const Ray& at, std::vector<Hit>& hits, TraceStatistics& statistics) const;

  // Where a ray that leaves `hit` to the side of `direction` must start so as not to meet the same surface again: a few
  // units of the last float place of the tile's or instance's size off the surface, along the geometric normal.
  Vec3 leave(const Hit& hit, Dir direction) const {
    return hit.position + hit.normal * double{dot(direction, hit.normal) >= 0 ? hit.step : -hit.step};
  }

  // How far off the surface of `hit` a visibility ray from a point `distance` m away must end so as not to meet the
  // surface: its start is rounded, too, unless it lies outside the frame of floats that the surface is met in.
  static double arrive(double step, double span, double distance) {
    constexpr double kFloat = 8 * 1.1920929e-7, kDouble = 1e-15;
    return step + kFloat * (distance < span ? distance : span) + kDouble * distance;
  }

  // The hit that a ray would have on a triangle of an object of a mesh, at barycentrics u and v of its vertices 1 and
  // 2; distance 0. time: s.
  Hit on_triangle(uint32_t object, uint32_t triangle, double u, double v, double time) const;
  // The same on an exact surface: a point of it and the normal there (any length), in its local frame, with its UV.
  Hit on_exact(uint32_t object, Vec3 local, Vec3 normal, Vec2 uv, double time) const;

  const Scene& scene() const;
  // Of a hit, or as each() numbers them.
  TracedObject object(uint32_t number) const {
    return number < plain_.size() ? static_cast<const TracedObject&>(plain_[number]) : nested_object(number);
  }
  // From the object's local frame (mesh origin included) to ENU, or to the axes of its node.
  Affine3 place(uint32_t number) const { return number < plain_.size() ? *plain_[number].place : nested_place(number); }
  // From the object's local frame to ENU at the time, exact.
  Affine3 to_world(uint32_t number, double time) const;
  Affine3 to_world(const Hit& hit) const { return to_world(hit.object, hit.time); }
  size_t object_count() const;  // each copy counted

  // When what an object hangs on may begin or end to move, to come and go or to change its material: times (s) inside
  // the window, ascending; more than there truly are. A timetable of more rows in the window is left out.
  static constexpr double kMostChanges = 10000;
  std::vector<double> changes(uint32_t number) const;
  bool there(uint32_t number, double time) const;  // an object, made as it is here
  std::string motion_name(uint32_t number) const;  // of the motion or timetable it hangs on, for messages
  Box3 local_box(uint32_t number) const;           // extent in its own frame; empty when unbounded

  // Visits at least one object of each kind: mesh or exact surface, and material override.
  void kinds(const std::function<void(const TracedObject&)>& visit) const;
  // Visits all objects that are wanted, in the order of their numbers. wanted is asked about what an object is, its
  // override, its tag and whether it has a node, on behalf of all copies. Error saying `what` they are when copies of
  // shared groups are more than kMostVisited.
  static constexpr double kMostVisited = 16777216;  // 2^24
  void each(const std::string& what, const std::function<bool(const TracedObject&)>& wanted,
            const std::function<void(uint32_t, const TracedObject&)>& visit) const;
  // The objects of one instance: one, but for its materials and its copies at the sides of a periodic cell.
  std::vector<uint32_t> of_instance(uint32_t instance) const;

  const std::optional<Periodic>& periodic() const;
  // The window; nothing when all is always at rest, whatever the time.
  std::optional<TimeSpan> window() const;
  bool has_holes() const { return has_holes_; }   // a filter decides about some surface, by Ray::draw
  const Box3& bounds() const { return bounds_; }  // ENU, all places that moving things have in the window
  size_t triangles() const;                       // instanced ones counted each time
  size_t tiles() const;
  size_t tiles_built() const;  // that are there
  TileUse tile_use() const;    // zeros without a limit
  TileForecast forecast() const;
  int useful_threads() const;  // one a core without a limit
  // Name and instruction set of the ray tracer, for result headers: "Embree 3.13.5 avx2".
  static std::string engine();

 private:
  friend class TracerCache;
  friend class AtWork;
  friend std::vector<const TileHull*> hulls_of(const Tracer& tracer);
  Tracer(std::shared_ptr<const World> world, TimeSpan window);
  void nearest_in_tiles(std::span<const Ray> rays, std::span<double> reach, std::span<Hit> hits, bool coherent,
                        TraceStatistics& statistics) const;
  void nearest_unbounded(std::span<const Ray> rays, std::span<Hit> hits, TraceStatistics& statistics) const;
  void occluded_in_tiles(std::span<const Ray> rays, std::span<double> reach, std::span<uint8_t> blocked, bool coherent,
                         TraceStatistics& statistics) const;
  double longest_step(Vec3 place) const;
  void add_all(const Ray& ray, double length, std::vector<Hit>& hits, TraceStatistics& statistics) const;
  std::shared_ptr<const World> world_;
  TracedObject nested_object(uint32_t number) const;
  Affine3 nested_place(uint32_t number) const;
  std::unique_ptr<MovingPart> moving_;   // null when nothing moves
  std::span<const PlacedObject> plain_;  // all objects, unless groups are shared
  Box3 bounds_;
  bool has_holes_ = false;
};

// A thread's work with a tracer, as long as this lives. Under a limit many threads at work wait for each other's tiles,
// which are then built less often; Tracer::useful_threads() is how many to start. Without a limit it does nothing.
class AtWork {
 public:
  explicit AtWork(const Tracer& tracer);
  ~AtWork();
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

 private:
  std::shared_ptr<const World> world_;
};

// Hands out the tracer of a time window. What is at rest is built once; windows in which everything that could move
// stays in the same place, and all that comes and goes is there or not throughout, share one tracer; of the others the
// last few are kept. Not for several threads at once.
class TracerCache {
 public:
  explicit TracerCache(std::shared_ptr<const Scene> scene, std::optional<Periodic> periodic = std::nullopt,
                       std::shared_ptr<const HitFilter> filter = nullptr, const TileLimit& limit = {});
  ~TracerCache();
  std::shared_ptr<const Tracer> get(TimeSpan window);
  size_t builds() const { return builds_; }  // tracers made so far
  TileUse tile_use() const;                  // of all of them

 private:
  struct Kept;
  std::shared_ptr<const World> world_;
  std::vector<std::unique_ptr<Kept>> kept_;  // the most recent last
  size_t builds_ = 0;
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
