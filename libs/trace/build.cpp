// From a scene to tiles with acceleration structures: what is at rest.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "motion/track.h"
#include "scene/primitives.h"
#include "trace/arrange.h"
#include "trace/embree_internal.h"
#include "trace/loose_mesh.h"

namespace suite {

namespace {

// Shares the scene's arrays with Embree; the pad float behind the vertices allows its 16-byte loads.
// holes: hits are put to the filter. object: whose geometry it is, for one that no instances share.
void attach_mesh(RTCScene scene, const Mesh& mesh, unsigned id, bool holes, uint32_t object = kNone) {
  mesh.require();
  RTCGeometry g = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0, 12,
                             mesh.vertex_count());
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0, 12,
                             mesh.triangle_count());
  rtcSetGeometryBuildQuality(g, RTC_BUILD_QUALITY_HIGH);
  rtcSetGeometryUserData(g, reinterpret_cast<void*>(uintptr_t{object}));
  if (holes) {
    rtcSetGeometryIntersectFilterFunction(g, filter_triangles);
    rtcSetGeometryOccludedFilterFunction(g, filter_triangles);
  }
  rtcCommitGeometry(g);
  rtcAttachGeometryByID(scene, g, id);
  rtcReleaseGeometry(g);
}

// Triangles of a lone mesh in a large scene that make it a tile: as many as gain more from being attached without an
// instance than rays lose by one more tile on their way.
constexpr size_t kHeavy = 4096;

bool pure_translation(const Affine3& m) { return m.a == Affine3{}.a; }

// Placed once and not turned: it can be attached as it is.
bool lone(const World& world, const PlacedObject& o) {
  return o.mesh != kNone && world.meshes[o.mesh].uses == 1 && pure_translation(*o.place);
}

// Neighbours in space become neighbours in memory (Morton 1966): rays that visit many small instances wait less.
void sort_in_space(std::vector<uint32_t>& objects, std::span<const Box3> boxes, const Box3& all) {
  const auto spread = [](uint64_t x) {  // 21 bits to every third bit
    x = (x | x << 32) & 0x1f00000000ffff, x = (x | x << 16) & 0x1f0000ff0000ff, x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
  };
  const Vec3 size = all.size();
  const double widest = std::max({size.x, size.y, size.z, 1e-300});
  std::vector<std::pair<uint64_t, uint32_t>> keys(objects.size());
  parallel_for(0, keys.size(), 4096, [&](size_t b, size_t e) {
    for (size_t k = b; k < e; ++k) {
      const Vec3 c = (boxes[objects[k]].center() - all.low) / widest * 2097151.0;
      keys[k] = {spread(static_cast<uint64_t>(c.x)) | spread(static_cast<uint64_t>(c.y)) << 1 |
                     spread(static_cast<uint64_t>(c.z)) << 2,
                 objects[k]};
    }
  });
  std::sort(keys.begin(), keys.end());
  for (size_t k = 0; k < keys.size(); ++k) objects[k] = keys[k].second;
}

}  // namespace

RTCScene new_scene(bool all_hits, bool loose) {
  RTCScene s = rtcNewScene(device());
  rtcSetSceneProgressMonitorFunction(
      s, [](void*, double) { return !stop_is_due(); }, nullptr);
  rtcSetSceneFlags(s, static_cast<RTCSceneFlags>((loose ? RTC_SCENE_FLAG_NONE : RTC_SCENE_FLAG_ROBUST) |
                                                 (all_hits ? RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION : 0)));
  // Among leaves splits in space are not worth what they take: 4 times the time to build, 4 % more memory, rays the
  // same.
  rtcSetSceneBuildQuality(s, loose ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH);
  return s;
}

void BuildOnce::go(const void* work, void (*call)(const void*)) const {
  const std::lock_guard lock(turn_);
  if (done()) return;
  isolated([&] { call(work); });
  done_.store(true, std::memory_order_release);
}

void Tile::build(const World& world) {
  const FlushDenormals flush;
  std::vector<uint32_t> meshes;
  for (const auto& set : sets)
    for (const uint32_t i : set->objects)
      if (const uint32_t m = world.flat.objects[i].mesh; m != kNone) meshes.push_back(m);
  std::sort(meshes.begin(), meshes.end());
  meshes.erase(std::unique(meshes.begin(), meshes.end()), meshes.end());
  parallel_for(0, meshes.size() + direct.size(), 1, [&](size_t b, size_t e) {
    const FlushDenormals flush_too;
    for (size_t i = b; i < e; ++i)
      if (i < meshes.size())
        world.mesh_scene(meshes[i]);
      else
        world.scene->meshes[world.flat.objects[direct[i - meshes.size()]].mesh].require();
  });
  constexpr size_t kCrown = 1024;  // triangles
  crowns = std::any_of(meshes.begin(), meshes.end(), [&](uint32_t m) {
    return world.meshes[m].loose && world.scene->meshes[m].triangle_count() >= kCrown;
  });
  for (const auto& set : sets)
    if (set->groups) world.build_placed(*set);
  handle.scene = new_scene(world.all_hits);
  for (uint32_t id = 0; id < direct.size(); ++id)
    attach_mesh(handle.scene, world.scene->meshes[world.flat.objects[direct[id]].mesh], id,
                world.filter && world.may_pass[direct[id]], direct[id]);
  for (uint32_t k = 0; k < sets.size(); ++k) sets[k]->attach(handle.scene, static_cast<unsigned>(direct.size()) + k);
  rtcCommitScene(handle.scene);
  // Tiles that may be given up need them again.
  for (const auto& set : sets)
    if (!world.memory) std::vector<Box3>().swap(set->boxes);
}

// Tiles of large scenes wait for the first ray; a few are built at once, which uses all threads better.
void TileSet::close(const World& world) {
  constexpr size_t kAtOnce = 8;
  std::vector<Box3> boxes;
  for (const auto& tile : tiles) boxes.push_back(tile->bounds);
  bvh.build(boxes);
  memory = world.memory.get();
  if (tiles.size() > kAtOnce || memory) return;
  for (const auto& tile : tiles) tile->once.run([&] { tile->build(world); });
}

RTCScene World::mesh_scene(uint32_t mesh) const {
  MeshEntry& entry = meshes[mesh];
  entry.once.run([&] {
    scene->meshes[mesh].require();
    entry.loose = is_loose(scene->meshes[mesh]);
    entry.handle.scene = new_scene(all_hits, entry.loose);
    attach_mesh(entry.handle.scene, scene->meshes[mesh], 0, filter && holed_meshes[mesh]);
    rtcCommitScene(entry.handle.scene);
  });
  return entry.handle.scene;
}

Affine3 World::pose(uint32_t node, double time) const {
  const MovingNode& n = flat.nodes[node];
  const Affine3 here = n.track == kNone ? n.before : n.before * scene->tracks[n.track].track->at(time).affine();
  return n.parent == kNone ? here : pose(n.parent, time) * here;
}

Presence World::presence_of(uint32_t node, TimeSpan window) const {
  Presence all{true, true, window};
  for (uint32_t n = node; n != kNone && all.any; n = flat.nodes[n].parent) {
    const MovingNode& m = flat.nodes[n];
    const Presence own = presence(*scene, m.track, m.schedule, m.made, window);
    all.hull = {std::max(all.hull.begin, own.hull.begin), std::min(all.hull.end, own.hull.end)};
    all.all = all.all && own.all;
    all.any = own.any && all.hull.begin <= all.hull.end;
  }
  return all;
}

bool World::there(uint32_t node, double time) const {
  for (uint32_t n = node; n != kNone; n = flat.nodes[n].parent) {
    const MovingNode& m = flat.nodes[n];
    const std::optional<uint32_t> made = made_at(*scene, m.track, m.schedule, time);
    if (!made || *made != m.made) return false;
  }
  return true;
}

void World::measure_meshes() {
  std::vector<bool> used(scene->meshes.size(), false);
  const auto mark = [&](const Assembly& frame) {
    for (const TracedObject& o : frame.objects)
      if (o.mesh != kNone) used[o.mesh] = true;
  };
  mark(flat);
  for (const SharedGroup& group : flat.groups) mark(group);
  parallel_for(0, scene->meshes.size(), 1, [&](size_t b, size_t e) {
    for (size_t i = b; i < e; ++i) {
      if (!used[i]) continue;
      const Mesh& mesh = scene->meshes[i];
      MeshEntry& m = meshes[i];
      m.box = mesh_box(mesh);
      m.room = {m.box.low - mesh.origin, m.box.high - mesh.origin};
      for (int a = 0; a < 3; ++a) m.scale = std::max({m.scale, std::fabs(m.room.low[a]), std::fabs(m.room.high[a])});
      m.room = enlarged(m.room, 16 * FLT_EPSILON * m.scale + 1e-30);
    }
  });
}

void World::find_holes() {
  holed_meshes.assign(scene->meshes.size(), 0);
  for (const TracedObject& o : flat.objects)
    may_pass.push_back((o.mesh != kNone || o.primitive != kNone) && filter->concerns(o));
  kinds([&](const TracedObject& o) {
    if (o.mesh != kNone && filter->concerns(o)) holed_meshes[o.mesh] = 1;
  });
}

World::World(std::shared_ptr<const Scene> given, std::optional<Periodic> cell, std::shared_ptr<const HitFilter> holes,
             const TileLimit& limit, double keep)
    : scene(std::move(given)),
      periodic(cell),
      filter(std::move(holes)),
      flat(flatten(*scene, keep)),
      meshes(new MeshEntry[scene->meshes.size()]),
      groups(new GroupEntry[flat.groups.size()]),
      all_hits(std::any_of(scene->materials.begin(), scene->materials.end(),
                           [](const Material& m) { return m.bounds_medium() || m.surface.curves.count("index"); })) {
  const FlushDenormals flush;
  if (limit.bytes) memory = std::make_unique<TileMemory>(limit, *this);
  measure_meshes();
  measure_groups();
  if (memory) memory->keep_meshes_of_groups();
  if (periodic) repeat_at_sides();
  if (filter) find_holes();
  for (const TracedObject& o : flat.objects)
    if (o.mesh != kNone) ++meshes[o.mesh].uses;
  triangles = triangles_in(flat);
  std::vector<Box3> boxes = boxes_in(flat, flat.fixed);
  std::vector<uint32_t> members;
  members.reserve(boxes.size());
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    bounds.grow(boxes[i]);
    if (!boxes[i].empty())
      members.push_back(i);
    else if (flat.objects[i].primitive != kNone)
      unbounded.push_back(i);
  }
  for (const uint32_t i : unbounded) {
    const Dir up = normalized(flat.objects[i].place->normal({0, 0, 1}));
    if (periodic && std::hypot(up.x, up.y) > 1e-9)
      throw Error("a plane or layer without bounds in a periodic scene is not level",
                  "tilted planes do not repeat themselves: give it a size");
  }
  const auto heavy = [&](uint32_t i) {
    return lone(*this, flat.objects[i]) && scene->meshes[flat.objects[i].mesh].triangle_count() >= kHeavy;
  };
  arrange(tiles, members, boxes, heavy, [&](Tile& tile, std::span<const uint32_t> own) { fill(tile, own, boxes); });
  // The boxes of a set are needed in its own order.
  for (const auto& tile : tiles.tiles)
    for (const auto& set : tile->sets) {
      set->boxes.reserve(set->objects.size());
      for (const uint32_t i : set->objects) set->boxes.push_back(enlarged(boxes[i], tile->slack()));
    }
  std::vector<Box3>().swap(boxes);
  tiles.close(*this);
}

// The largest unrotated, once-used mesh of a tile gives it its origin and is attached without an instance, with all
// others that stand at the same origin.
void World::fill(Tile& tile, std::span<const uint32_t> members, std::span<const Box3> boxes) {
  size_t most = 0;
  const auto place = [&](const PlacedObject& o) { return o.place->b + scene->meshes[o.mesh].origin; };
  const double reach = length(tile.bounds.size()) + kTileSize;
  for (const uint32_t i : members) {
    const PlacedObject& o = flat.objects[i];
    if (!lone(*this, o) || length(place(o) - tile.bounds.center()) > reach) continue;
    if (const size_t n = scene->meshes[o.mesh].triangle_count(); n > most) most = n, tile.origin = place(o);
  }
  std::vector<uint32_t> placed;
  for (const uint32_t i : members) {
    const PlacedObject& o = flat.objects[i];
    (most && lone(*this, o) && place(o) == tile.origin ? tile.direct : placed).push_back(i);
  }
  tile.sets = sets_of(flat, tile.origin, tile.bounds, placed, boxes);
}

std::vector<std::unique_ptr<PlacedSet>> World::sets_of(const Assembly& frame, Vec3 origin, const Box3& within,
                                                       std::span<const uint32_t> members,
                                                       std::span<const Box3> boxes) const {
  std::vector<std::unique_ptr<PlacedSet>> sets;
  for (const bool groups_only : {false, true}) {
    auto set = std::make_unique<PlacedSet>();
    set->world = this, set->frame = &frame, set->groups = groups_only, set->origin = origin;
    for (const uint32_t i : members)
      if ((frame.shared_of(i) != kNone) == groups_only && !boxes[i].empty()) set->objects.push_back(i);
    if (set->objects.empty()) continue;
    set->objects.shrink_to_fit();
    sort_in_space(set->objects, boxes, within);
    set->fill_inverse();
    sets.push_back(std::move(set));
  }
  return sets;
}

// What sticks out of the cell comes in again on the other side: copies shifted by whole cells, where they reach it.
void World::repeat_at_sides() {
  const Periodic& cell = *periodic;
  if (!(cell.size.x > 0 && cell.size.y > 0)) throw Error("the cell of a periodic scene needs a positive size");
  if (flat.fixed != flat.objects.size())
    throw Error("a periodic scene cannot hold anything that moves, comes or goes",
                "drop the motion or the schedule, or the periodic cell");
  const size_t count = flat.objects.size();
  for (size_t i = 0; i < count; ++i) {
    const PlacedObject o = flat.objects[i];
    const Box3 b = transformed(local_box(flat, i), *o.place);
    if (b.empty()) continue;
    const auto reach = [](double low, double high, double from, double size) {
      const double first = std::floor((low - from) / size), last = std::ceil((high - from) / size) - 1;
      if (!(last - first <= 64))
        throw Error("an object is more than 64 times as wide as the cell of the periodic scene",
                    "make the cell larger");
      if (!(std::fabs(first) < 0x1p52))
        throw Error("an object lies too many cells away from the cell of the periodic scene", "make the cell larger");
      return std::pair{static_cast<long>(first), static_cast<long>(last)};
    };
    const auto [x0, x1] = reach(b.low.x, b.high.x, cell.low.x, cell.size.x);
    const auto [y0, y1] = reach(b.low.y, b.high.y, cell.low.y, cell.size.y);
    for (long x = x0; x <= std::max(x0, x1); ++x)
      for (long y = y0; y <= std::max(y0, y1); ++y) {
        PlacedObject copy = o;
        if (x != 0 || y != 0)
          copy.place = &flat.composed.emplace_back(
              translation({-static_cast<double>(x) * cell.size.x, -static_cast<double>(y) * cell.size.y, 0}) *
              *o.place);
        if (x == x0 && y == y0) {
          flat.objects[i] = copy;
          continue;
        }
        flat.objects.push_back(copy);
        if (!flat.shared.empty()) flat.shared.push_back(flat.shared[i]);
      }
  }
  flat.fixed = flat.objects.size();
  flat.number_objects();
}

}  // namespace suite
