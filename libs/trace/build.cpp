// From a scene to tiles with acceleration structures.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <map>
#include <tuple>

#include "base/parallel.h"
#include "scene/primitives.h"
#include "trace/embree_internal.h"
#include "trace/flatten.h"

namespace suite {

namespace {

constexpr double kTileSize = 2048;  // m: float positions inside are good to 0.1 mm

RTCScene new_scene() {
  RTCScene s = rtcNewScene(device());
  rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_HIGH);
  return s;
}

// Shares the scene's arrays with Embree; the pad float behind the vertices allows its 16-byte loads.
// holes: hits are put to the filter.
void attach_mesh(RTCScene scene, const Mesh& mesh, unsigned id, bool holes) {
  RTCGeometry g = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0, 12, mesh.vertex_count());
  rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0, 12, mesh.triangle_count());
  rtcSetGeometryBuildQuality(g, RTC_BUILD_QUALITY_HIGH);
  if (holes) {
    rtcSetGeometryIntersectFilterFunction(g, filter_triangles);
    rtcSetGeometryOccludedFilterFunction(g, filter_triangles);
  }
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

bool unbounded(const Scene& scene, const TracedObject& o) { return o.primitive != kNone && primitive_box(scene.primitives[o.primitive]).empty(); }

// What the steps of the construction share.
struct Build {
  const Scene& scene;
  const std::vector<TracedObject>& objects;
  TracerCore& core;
  std::vector<Box3> boxes;                   // of objects, ENU; empty for unbounded ones
  std::vector<uint32_t> uses;                // of meshes
  std::vector<char> needs_scene, direct;     // meshes that are instanced; objects attached without an instance

  Box3 measure();
  std::vector<std::vector<uint32_t>> group(const Box3& bounds) const;
  void make_tile(const std::vector<uint32_t>& members);
  void choose_origin(Tile& tile);
  void commit();
};

// Bounds of all objects and how often each mesh is used.
Box3 Build::measure() {
  std::vector<Box3> mesh_boxes(scene.meshes.size());
  parallel_for(0, mesh_boxes.size(), 1, [&](size_t b, size_t e) {
    for (size_t i = b; i < e; ++i) mesh_boxes[i] = local_bounds(scene.meshes[i]);
  });
  uses.assign(scene.meshes.size(), 0);
  for (const TracedObject& o : objects)
    if (o.mesh != kNone) ++uses[o.mesh];
  boxes.resize(objects.size());
  parallel_for(0, objects.size(), 4096, [&](size_t b, size_t e) {
    for (size_t i = b; i < e; ++i) {
      const TracedObject& o = objects[i];
      boxes[i] = transformed(o.mesh != kNone ? mesh_boxes[o.mesh] : primitive_box(scene.primitives[o.primitive]), o.to_world);
    }
  });
  Box3 all;
  for (const Box3& b : boxes) all.grow(b);
  needs_scene.assign(scene.meshes.size(), 0);
  direct.assign(objects.size(), 0);
  core.tile_of_object.assign(objects.size(), kNone);
  core.mesh_scenes.resize(scene.meshes.size());
  return all;
}

// One tile for a scene of a few kilometres, a grid by centres otherwise; what is larger than a cell gets its own.
std::vector<std::vector<uint32_t>> Build::group(const Box3& bounds) const {
  std::map<std::tuple<long, long, long, long>, std::vector<uint32_t>> cells;
  const auto widest = [](Vec3 size) { return std::max({size.x, size.y, size.z}); };
  const bool single = bounds.empty() || widest(bounds.size()) <= 2 * kTileSize;
  for (uint32_t i = 0; i < objects.size(); ++i) {
    if (boxes[i].empty()) continue;
    const Vec3 c = boxes[i].center();
    if (single) cells[{0, 0, 0, 0}].push_back(i);
    else if (widest(boxes[i].size()) > 2 * kTileSize) cells[{0, 0, 0, 1 + static_cast<long>(i)}].push_back(i);
    else cells[{std::lround(c.x / kTileSize), std::lround(c.y / kTileSize), std::lround(c.z / kTileSize), 0}].push_back(i);
  }
  std::vector<std::vector<uint32_t>> groups;
  for (auto& [key, members] : cells) groups.push_back(std::move(members));
  return groups;
}

// The largest unrotated, once-used mesh of a tile gives it its origin and is attached without an instance.
void Build::choose_origin(Tile& tile) {
  size_t most = 0;
  tile.origin = tile.bounds.center();
  const auto lone = [&](uint32_t i) { return pure_translation(objects[i].to_world) && uses[objects[i].mesh] == 1; };
  const auto place = [&](uint32_t i) { return objects[i].to_world.b + scene.meshes[objects[i].mesh].origin; };
  for (const uint32_t i : tile.objects) {
    const size_t triangles = scene.meshes[objects[i].mesh].triangle_count();
    if (!lone(i) || triangles <= most || length(place(i) - tile.bounds.center()) > length(tile.bounds.size()) + kTileSize) continue;
    most = triangles;
    tile.origin = place(i);
  }
  for (const uint32_t i : tile.objects) {
    direct[i] = lone(i) && place(i) == tile.origin;
    if (!direct[i]) needs_scene[objects[i].mesh] = 1;
  }
}

void Build::make_tile(const std::vector<uint32_t>& members) {
  Tile& tile = core.tiles.emplace_back();
  auto set = std::make_unique<PrimitiveSet>();
  for (const uint32_t i : members) {
    tile.bounds.grow(boxes[i]);
    core.tile_of_object[i] = static_cast<uint32_t>(core.tiles.size() - 1);
    if (objects[i].mesh != kNone) tile.objects.push_back(i);
    else set->members.push_back({&scene.primitives[objects[i].primitive], objects[i].to_world.inverse(), i, boxes[i]});
  }
  choose_origin(tile);
  const Vec3 low = tile.bounds.low - tile.origin, high = tile.bounds.high - tile.origin;
  for (int a = 0; a < 3; ++a) tile.scale = std::max({tile.scale, std::fabs(low[a]), std::fabs(high[a])});
  // Float rounding may move geometry out of the exact bounds by some ulp.
  const double slack = 16 * FLT_EPSILON * tile.scale + 1e-9;
  // Rays are advanced to these bounds. Embree's coherent packets miss surfaces that lie within some ulp of where their
  // rays begin (seen with 3.13.5 and an instanced sheet in the upper face of a tile), so they begin well before.
  const double lead = slack + tile.scale / 1024;
  tile.bounds.low -= {lead, lead, lead};
  tile.bounds.high += {lead, lead, lead};
  if (set->members.empty()) return;
  set->origin = tile.origin;
  set->slack = slack;
  tile.primitives = std::move(set);
}

void Build::commit() {
  std::vector<char> holes(scene.meshes.size(), 0);
  if (core.filter)
    for (size_t i = 0; i < objects.size(); ++i)
      if (core.may_pass[i] && objects[i].mesh != kNone) holes[objects[i].mesh] = 1;
  for (size_t m = 0; m < scene.meshes.size(); ++m)
    if (needs_scene[m]) {
      core.mesh_scenes[m].scene = new_scene();
      attach_mesh(core.mesh_scenes[m].scene, scene.meshes[m], 0, holes[m]);
      rtcCommitScene(core.mesh_scenes[m].scene);
    }
  std::vector<Box3> tile_boxes;
  for (Tile& tile : core.tiles) {
    tile.scene.scene = new_scene();
    for (uint32_t id = 0; id < tile.objects.size(); ++id) {
      const TracedObject& o = objects[tile.objects[id]];
      const Mesh& mesh = scene.meshes[o.mesh];
      if (direct[tile.objects[id]]) attach_mesh(tile.scene.scene, mesh, id, holes[o.mesh]);
      else attach_instance(tile.scene.scene, core.mesh_scenes[o.mesh].scene, translation(-tile.origin) * o.to_world * translation(mesh.origin), id);
    }
    if (tile.primitives) attach_primitives(tile.scene.scene, *tile.primitives, static_cast<unsigned>(tile.objects.size()));
    rtcCommitScene(tile.scene.scene);
    tile_boxes.push_back(tile.bounds);
  }
  core.bvh.build(tile_boxes);
}

// What sticks out of the cell comes in again on the other side: copies shifted by whole cells, where they reach it.
void repeat_at_sides(const Scene& scene, const Periodic& cell, std::vector<TracedObject>& objects) {
  if (!(cell.size.x > 0 && cell.size.y > 0)) throw Error("the cell of a periodic scene needs a positive size");
  const size_t count = objects.size();
  std::vector<Box3> mesh_boxes;
  for (const Mesh& m : scene.meshes) mesh_boxes.push_back(local_bounds(m));
  for (size_t i = 0; i < count; ++i) {
    const TracedObject o = objects[i];
    const Box3 b = transformed(o.mesh != kNone ? mesh_boxes[o.mesh] : primitive_box(scene.primitives[o.primitive]), o.to_world);
    if (b.empty()) continue;
    const auto reach = [](double low, double high, double from, double size) {
      return std::pair{static_cast<long>(std::floor((low - from) / size)), static_cast<long>(std::ceil((high - from) / size)) - 1};
    };
    const auto [x0, x1] = reach(b.low.x, b.high.x, cell.low.x, cell.size.x);
    const auto [y0, y1] = reach(b.low.y, b.high.y, cell.low.y, cell.size.y);
    if (x1 - x0 > 64 || y1 - y0 > 64) throw Error("an object is more than 64 times as wide as the cell of the periodic scene", "make the cell larger");
    for (long x = x0; x <= std::max(x0, x1); ++x)
      for (long y = y0; y <= std::max(y0, y1); ++y) {
        TracedObject copy = o;
        copy.to_world = translation({-static_cast<double>(x) * cell.size.x, -static_cast<double>(y) * cell.size.y, 0}) * o.to_world;
        if (x == x0 && y == y0) objects[i] = copy;
        else objects.push_back(copy);
      }
  }
}

}  // namespace

Tracer::Tracer(std::shared_ptr<const Scene> scene, std::optional<Periodic> periodic, std::shared_ptr<const HitFilter> filter)
    : scene_(std::move(scene)), periodic_(periodic), objects_(flatten(*scene_)), core_(new TracerCore) {
  const FlushDenormals flush;
  const Scene& s = *scene_;
  std::erase_if(objects_, [&](const TracedObject& o) { return o.mesh != kNone && s.meshes[o.mesh].triangle_count() == 0; });
  if (periodic_) repeat_at_sides(s, *periodic_, objects_);
  for (const TracedObject& o : objects_)
    if (o.mesh != kNone) triangles_ += s.meshes[o.mesh].triangle_count();
  core_->filter = std::move(filter);
  if (core_->filter)
    for (const TracedObject& o : objects_) core_->may_pass.push_back(core_->filter->concerns(o));
  Build build{s, objects_, *core_, {}, {}, {}, {}};
  bounds_ = build.measure();
  for (uint32_t i = 0; i < objects_.size(); ++i)
    if (unbounded(s, objects_[i])) core_->unbounded.push_back({objects_[i].to_world.inverse(), i});
  for (const std::vector<uint32_t>& members : build.group(bounds_)) build.make_tile(members);
  build.commit();
}

}  // namespace suite
