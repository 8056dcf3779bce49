// What the parts of the tracer share: Embree handles, tiles, sets of instances, and what Embree's callbacks are given.
// Internal.
#pragma once
#include <embree3/rtcore.h>

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scene/presence.h"
#include "trace/build_once.h"
#include "trace/flatten.h"
#include "trace/hit_filter.h"
#include "trace/primitive_hit.h"
#include "trace/tile_bvh.h"
#include "trace/tile_hull.h"
#include "trace/tile_memory.h"
#include "trace/tracer.h"

namespace suite {

inline constexpr uint32_t kWidth = 8;  // rays in a packet

// One device per process, its instruction set pinned: other sets give other last bits.
RTCDevice device();
// all_hits: Tracer::all may be asked of it. loose: of a mesh that is (loose_mesh.h).
RTCScene new_scene(bool all_hits, bool loose = false);

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

// A mesh that instances share, with its own acceleration structure.
struct MeshEntry {
  Box3 box;            // local, mesh origin included
  Box3 room;           // around the floats (without the mesh's origin), enlarged by what float rounding moves
  double scale = 0;    // largest float coordinate
  uint32_t uses = 0;   // objects
  bool loose = false;  // as is_loose; known when it is built
  SceneHandle handle;
  BuildOnce once;
};

// Eight rays of a list against one tile, advanced to where they enter it (m).
struct Packet {
  uint32_t ray[kWidth];
  double advance[kWidth];
  uint32_t size = 0;
};

struct MovingPart;
struct PlacedSet;
struct World;

// One of all the hits of a ray. exact: of an exact surface, whose t counts from the ray's origin in m.
struct Gathered {
  uint32_t number, triangle;
  float u, v;
  std::optional<LocalHit> exact;
};

// Handed to Embree and by it to the callbacks: the unrounded rays. Inside a shared group rays have a context of their
// own, with the one ray as the group's frame sees it.
struct TraceContext : RTCIntersectContext {
  const Ray* rays = nullptr;
  const Packet* packet = nullptr;  // lanes are the ids of the float rays
  const World* world = nullptr;
  const MovingPart* moving = nullptr;
  const double* reach = nullptr;              // of visibility rays: how far each goes, unrounded
  const PlacedSet* set = nullptr;             // the instance that rays are inside of; null = in the frame itself
  uint32_t prim = 0;                          // its position in the set
  std::vector<Gathered>* gathered = nullptr;  // all hits go here, and none ends a ray
  // Of a shared group: the context around it, which is inside its placement, and the number of its first object; the
  // ray in ENU, where on it (m) the frame's ray begins, and how long one metre of it is here.
  const TraceContext* outer = nullptr;
  uint32_t first = 0;
  const Ray* enu = nullptr;
  double start = 0, stretch = 1;
  // What a lane has met inside a shared group: the number of the object and its mesh.
  struct Inside {
    uint32_t number, mesh;
  } inside[kWidth];
  const Ray& ray(unsigned id) const { return rays[packet->ray[id]]; }
  const Ray& enu_ray(unsigned id) const { return outer ? *enu : ray(id); }
  // How far a lane goes along its ray, whose float says `far` beyond where it was advanced to.
  double reach_of(unsigned id, float far) const {
    return reach ? reach[packet->ray[id]] : packet->advance[id] + double{far};
  }
};

// Placements of one frame as one Embree user geometry: either instances of meshes and exact surfaces, or placements of
// shared groups. Ids of its primitives are positions in `objects`.
struct PlacedSet {
  // From the frame into the floats of an instance that rests in the window; one cache line.
  struct Inverse {
    static constexpr uint32_t kExact = 0x80000000u;
    Vec3 base;        // place of the floats' (0, 0, 0) in the frame
    float linear[9];  // column-major; RestingInward reads 4 at a time, `thing` among them
    uint32_t thing;   // a mesh, or kExact + an exact surface without holes; kNone: other exact surfaces
  };
  // The same of a shared group, whose own objects may be far smaller than float could tell in it.
  struct DeepInverse {
    Vec3 base;
    double linear[9];
    uint32_t group, number;  // the shared group, and the number of its first object, counted as the frame does
  };
  const World* world = nullptr;
  const Assembly* frame = nullptr;
  const MovingPart* moving = nullptr;  // null: all at rest
  bool partly = false;                 // all are there for a part of the window only
  bool groups = false;                 // all are placements of shared groups
  Vec3 origin;                         // of the tile
  unsigned times = 1;                  // boxes of an object, equally spaced over the window
  std::vector<uint32_t> objects;       // indices into the frame's objects
  std::vector<Inverse> inverse;        // of each object; empty when they move within the window
  std::vector<DeepInverse> deep;       // the same of groups
  std::vector<Box3> boxes;             // [object][time], in the frame; until the tile is built

  void fill_inverse();                       // from the poses of the window
  uint32_t thing_of(uint32_t object) const;  // Inverse::thing
  void attach(RTCScene scene, unsigned id);
  // Where an object's floats have their zero, in its own frame.
  Vec3 zero_of(uint32_t object) const;
  // The number of an object as its frame counts.
  uint32_t number_of(uint32_t object) const;
};
// Embree's callbacks for sets of groups.
void intersect_groups(const RTCIntersectFunctionNArguments* args);
void occlude_groups(const RTCOccludedFunctionNArguments* args);

// A shared group, with its own acceleration structure.
struct GroupEntry {
  Box3 box;          // in its frame
  Vec3 origin;       // of the floats: the middle of the box
  Box3 room;         // around the floats, enlarged by what float rounding moves
  double scale = 0;  // largest float coordinate
  size_t triangles = 0;
  double slack() const { return 16 * 1.1920929e-7 * scale + 1e-30; }  // as of Tile
  std::vector<std::unique_ptr<PlacedSet>> sets;                       // geometry ids are positions in it
  SceneHandle handle;
  BuildOnce once;
};

// Geometry ids inside a tile: first the meshes that are attached as they are, then the sets.
struct Tile {
  Vec3 origin;                   // ENU
  Box3 bounds;                   // ENU, a little enlarged
  double scale = 0;              // largest float coordinate of the tile, m
  bool crowns = false;           // loose meshes of many leaves are placed in it; known when it is built
  std::vector<uint32_t> direct;  // indices into the scene's objects
  std::vector<std::unique_ptr<PlacedSet>> sets;
  SceneHandle handle;
  BuildOnce once;   // where there is no limit
  TileState state;  // where there is one
  TileHull hull;    // likewise, from the first building on

  bool built() const { return once.done() || state.built(); }
  // What float rounding may move geometry out of its exact bounds by, m.
  double slack() const { return 16 * 1.1920929e-7 * scale + 1e-9; }
  void build(const World& world);
};

struct TileSet {
  std::vector<std::unique_ptr<Tile>> tiles;
  TileBvh bvh;
  TileMemory* memory = nullptr;  // that knows tiles of this set

  TileSet() = default;
  ~TileSet() {
    if (memory) memory->forget(*this);
  }
  TileSet(const TileSet&) = delete;
  TileSet& operator=(const TileSet&) = delete;
  void close(const World& world);  // after the tiles are filled: the hierarchy, and small sets are built at once
  // Sends every ray through its tiles, nearest first, eight rays that are at the same tile at a time.
  // The tile is built while send(tile, packet) runs, which traces a packet and lowers reach[] of rays that need not go
  // on.
  template <class Send>
  void pass(const World& world, std::span<const Ray> rays, std::span<double> reach, const Send& send) const;
};

// Embree's filter for triangles of meshes that may have holes.
void filter_triangles(const RTCFilterFunctionNArguments* args);
// The filter of contexts that gather: notes the triangle and lets the ray pass.
void gather_triangles(const RTCFilterFunctionNArguments* args);

// An object as the filter of holes is asked about it.
struct Asked {
  const TracedObject& object;
  uint32_t number;
  bool may_pass;
};

// Where an exact surface is, both ways.
struct ExactPose {
  Affine3 to_world, to_local;
  bool mirrored;
  explicit ExactPose(const Affine3& place)
      : to_world(place), to_local(place.inverse()), mirrored(place.determinant() < 0) {}
};

// What does not change with the window.
struct World {
  World(std::shared_ptr<const Scene> scene, std::optional<Periodic> periodic, std::shared_ptr<const HitFilter> filter,
        const TileLimit& limit, double keep);
  std::shared_ptr<const Scene> scene;
  std::optional<Periodic> periodic;
  std::shared_ptr<const HitFilter> filter;  // null: no surface has holes
  Flattened flat;
  std::unique_ptr<MeshEntry[]> meshes;
  std::unique_ptr<GroupEntry[]> groups;  // of the shared groups
  std::unique_ptr<TileMemory> memory;    // null: no limit. Outlives the tiles
  TileSet tiles;                         // of what is at rest
  std::vector<uint32_t> unbounded;       // exact surfaces without bounds at rest, met in double one by one
  Box3 bounds;                           // of what is at rest
  size_t triangles = 0;
  bool all_hits = false;           // some surface bounds a medium or may refract: Tracer::all may be asked
  std::vector<char> may_pass;      // objects with holes; empty without a filter
  std::vector<char> holed_meshes;  // meshes that some such object shows; empty without a filter

  // Asks the filter about a point of an object that has holes.
  bool keeps(const Ray& ray, const Asked& asked, uint32_t triangle, double u, double v, Vec3 position,
             Vec3 normal = {}) const;
  // First hit of an exact surface between t_min and t_max beyond `from` (m along the ray) that the filter does not let
  // through; its t counts from there, and again(t) is where to look for the next.
  static double again(double t) { return t + 1e-12 * std::max(1.0, std::fabs(t)); }
  std::optional<LocalHit> meet(const Ray& ray, const Asked& asked, const ExactPose& pose, double from, double t_min,
                               double t_max) const;
  Asked asked(uint32_t object) const { return {flat.objects[object], flat.number(object), filter && may_pass[object]}; }
  Asked asked(const Way& way) const { return {way.object, way.number, filter && filter->concerns(way.object)}; }
  // The way to the instance that a context's rays are inside of.
  Way way(const TraceContext& context) const {
    const uint32_t object = context.set->objects[context.prim];
    if (!context.outer) return flat.way(object);
    Way at = way(*context.outer);
    flat.step(at, static_cast<const SharedGroup&>(*context.set->frame), object);
    return at;
  }
  // The number of that instance.
  uint32_t number(const TraceContext& context) const {
    return context.first + context.set->number_of(context.set->objects[context.prim]);
  }
  RTCScene mesh_scene(uint32_t mesh) const;        // built on the first call
  Affine3 pose(uint32_t node, double time) const;  // exact; while it is there
  Presence presence_of(uint32_t node, TimeSpan window) const;
  bool there(uint32_t node, double time) const;
  RTCScene group_scene(uint32_t group) const;  // likewise
  void build_placed(const PlacedSet& set) const;
  Affine3 to_world(const PlacedObject& o, double time) const {
    return o.node == kNone ? *o.place : pose(o.node, time) * *o.place;
  }
  Affine3 to_world(const Way& way, double time) const {
    return way.object.node == kNone ? way.place : pose(way.object.node, time) * way.place;
  }
  // Extent in the own frame of an object of a frame; empty when unbounded.
  Box3 local_box(const Assembly& frame, size_t object) const;
  // Visits at least one object of each kind, as Tracer::kinds.
  void kinds(const std::function<void(const TracedObject&)>& visit) const;
  // Puts objects of a frame into sets of instances and of groups, in the order of the space `within`. boxes: of all
  // objects.
  std::vector<std::unique_ptr<PlacedSet>> sets_of(const Assembly& frame, Vec3 origin, const Box3& within,
                                                  std::span<const uint32_t> members, std::span<const Box3> boxes) const;
  // Boxes of the first `count` objects of a frame, in it.
  std::vector<Box3> boxes_in(const Assembly& frame, size_t count) const;

 private:
  void measure_meshes();  // that something shows
  void measure_groups();
  size_t triangles_in(const Assembly& frame) const;
  void find_holes();
  void repeat_at_sides();
  void fill(Tile& tile, std::span<const uint32_t> members, std::span<const Box3> boxes);
};

// What moves in a window.
struct MovingPart {
  MovingPart(const World& world, TimeSpan window);
  // Stretches of time between kinks, each with equidistant poses.
  struct Stretch {
    double begin, end;
    size_t first, count;
  };
  struct Keys {
    std::vector<Stretch> stretches;
    std::vector<Affine3> poses;
    double radius = 0;    // of what moves with the node, m
    double bound = 0;     // m, between keys; 0 for an instant, which is exact
    bool used = false;    // something hangs on the node itself
    bool partly = false;  // it is there for a part of the window only
    Affine3 at(double time) const;
    bool absent() const { return poses.empty(); }  // or nothing hangs on the node itself
    bool at_rest() const { return poses.size() <= 1; }
  };
  const World& world;
  TimeSpan window;
  std::vector<Keys> nodes;
  TileSet tiles;
  std::vector<uint32_t> unbounded;
  Box3 bounds;

  float fraction(double time) const;  // of the window, 0 to 1
  // As rays see it: linear between keys.
  Affine3 to_world(const PlacedObject& o, double time) const { return nodes[o.node].at(time) * *o.place; }
  // Whether an object that is there for a part of the window is there at a time.
  bool there(uint32_t object, double time) const;
  // Of a node that something hangs on.
  static Keys keys_of(const World& world, TimeSpan window, uint32_t node, double radius);

 private:
  void fill(Tile& tile, std::span<const uint32_t> members, std::span<const std::vector<Box3>> boxes);
};

// The boxes of a moving object at 1, 2, 5, 17 or 65 equidistant times of the window, so that what is linear between
// them holds the object at all times (at 1: the box of the whole way). As few times as keep the boxes tight.
std::vector<Box3> boxes_over(const MovingPart::Keys& keys, TimeSpan window, const Box3& box_in_node);

// One packet against one tile. Hits are noted while rays go from tile to tile and made when all of them have arrived:
// triangles met far apart are not in the caches, and all are sent for before the first is waited for.
class PacketTracer {
 public:
  PacketTracer(const World& world, const MovingPart* moving, std::span<const Ray> rays, std::span<double> reach,
               bool coherent, TraceStatistics& statistics)
      : world_(world),
        moving_(moving),
        rays_(rays),
        reach_(reach),
        coherent_(coherent),
        statistics_(statistics),
        found_(kept()) {}
  // Before the first nearest().
  void begin() {
    found_.resize(rays_.size());
    for (Found& f : found_) f.object = kNone;
  }
  void nearest(const Tile& tile, const Packet& packet);
  // Makes the hits that nearest() found; others stay as they are.
  void finish(std::span<Hit> hits);
  // Adds all hits of a packet of one ray.
  void all(const Tile& tile, const Packet& packet, std::vector<Hit>& hits);
  void all_unbounded(uint32_t object, std::vector<Hit>& hits);
  void occluded(const Tile& tile, const Packet& packet, std::span<uint8_t> blocked);
  // A surface without bounds (an object of the scene) and all rays, as occluded(); blocked empty: as nearest().
  void unbounded(uint32_t object, std::span<uint8_t> blocked);

 private:
  void load(const Tile& tile, const Packet& packet, RTCRay8& q, int* valid) const;
  RTCRay float_ray(const Tile& tile, const Packet& packet, uint32_t i) const;
  void send(const Tile& tile, const Packet& packet, TraceContext& context, RTCRayHit8& rays);
  TraceContext context(const Packet& packet) const;
  struct MetIds {  // of Embree
    unsigned geometry, instance, primitive;
  };
  bool one_by_one(const Tile& tile) const;
  void nearest_one_by_one(const Tile& tile, const Packet& packet, TraceContext& context);
  void note(const Tile& tile, const Packet& packet, uint32_t i, const TraceContext& c, float far, const MetIds& met,
            float u, float v);
  // What a ray met in a tile; object kNone: nothing.
  struct Found {
    const Tile* tile;                         // null: a surface without bounds
    uint32_t object, number, mesh, triangle;  // object: of the scene's own, which may hold the one of this number
    float u, v;
    bool direct;
  };
  const uint32_t* corners(const Found& found) const;
  Affine3 seen_at(const Way& way, double time) const;
  double exact_time(const Ray& ray) const;
  void finish_triangle(const Found& found, const Ray& ray, Hit& hit) const;
  void finish_exact(double scale, const Ray& ray, const Asked& asked, const ExactPose& pose, double near,
                    Hit& hit) const;
  void place_exact(double scale, const Ray& ray, const Asked& asked, const ExactPose& pose, const LocalHit& found,
                   Hit& hit) const;

  bool absent(uint32_t object, const Ray& ray) const;

  const World& world_;
  const MovingPart* moving_;
  std::span<const Ray> rays_;
  std::span<double> reach_;
  bool coherent_;
  TraceStatistics& statistics_;
  static std::vector<Found>& kept();  // the thread's memory for
  std::vector<Found>& found_;         // what each ray met
};

}  // namespace suite
