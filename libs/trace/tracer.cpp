#include "trace/tracer.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>

#include "base/interrupt.h"
#include "trace/cell_walk.h"
#include "trace/embree_internal.h"

namespace suite {

RTCDevice device() {
  static const RTCDevice made = [] {
    RTCDevice d = rtcNewDevice("isa=avx2,threads=0");
    if (!d) throw Error("Embree cannot be started", "a processor with AVX2 is needed");
    rtcSetDeviceErrorFunction(
        d,
        [](void*, RTCError code, const char* text) {
          if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
          if (code == RTC_ERROR_CANCELLED) throw Stopped{};  // by the monitor of build.cpp
          throw Bug(strf("Embree error %d: %s", static_cast<int>(code), text ? text : ""));
        },
        nullptr);
    return d;
  }();
  return made;
}

FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040); }
FlushDenormals::~FlushDenormals() { _mm_setcsr(saved_); }

Tracer::Tracer(std::shared_ptr<const Scene> scene, std::optional<Periodic> periodic, TimeSpan window,
               std::shared_ptr<const HitFilter> filter, const TileLimit& limit, double keep)
    : Tracer(std::make_shared<const World>(std::move(scene), periodic, std::move(filter), limit, keep), window) {}

Tracer::Tracer(std::shared_ptr<const World> world, TimeSpan window)
    : world_(std::move(world)), bounds_(world_->bounds), has_holes_(world_->filter != nullptr) {
  if (world_->flat.groups.empty()) plain_ = world_->flat.objects;
  if (world_->flat.fixed == world_->flat.objects.size()) return;
  const FlushDenormals flush;
  moving_ = std::make_unique<MovingPart>(*world_, window);
  bounds_.grow(moving_->bounds);
}

Tracer::~Tracer() = default;
const Scene& Tracer::scene() const { return *world_->scene; }
const std::optional<Periodic>& Tracer::periodic() const { return world_->periodic; }
std::optional<TimeSpan> Tracer::window() const { return moving_ ? std::optional(moving_->window) : std::nullopt; }
size_t Tracer::triangles() const { return world_->triangles; }
size_t Tracer::tiles() const { return world_->tiles.tiles.size() + (moving_ ? moving_->tiles.tiles.size() : 0); }
size_t Tracer::tiles_built() const {
  const auto count = [](const TileSet& set) {
    return static_cast<size_t>(
        std::count_if(set.tiles.begin(), set.tiles.end(), [](const auto& t) { return t->built(); }));
  };
  return count(world_->tiles) + (moving_ ? count(moving_->tiles) : 0);
}
TileUse Tracer::tile_use() const { return world_->memory ? world_->memory->use() : TileUse{}; }
TileForecast Tracer::forecast() const {
  TileForecast f;
  const auto add = [&](const TileSet& set) {
    for (const auto& tile : set.tiles) {
      const uint64_t structures = structures_of(*tile, *world_), geometry = geometry_of(*tile, *world_, Arrays::all);
      ++f.tiles, f.structures += structures, f.geometry += geometry;
      f.largest = std::max(f.largest, structures + geometry);
    }
  };
  add(world_->tiles);
  if (moving_) add(moving_->tiles);
  f.structures += structures_of_groups(*world_), f.geometry += geometry_of_groups(*world_, Arrays::all);
  return f;
}
std::string Tracer::engine() {
  return strf("Embree %d.%d.%d avx2",
              static_cast<int>(rtcGetDeviceProperty(device(), RTC_DEVICE_PROPERTY_VERSION_MAJOR)),
              static_cast<int>(rtcGetDeviceProperty(device(), RTC_DEVICE_PROPERTY_VERSION_MINOR)),
              static_cast<int>(rtcGetDeviceProperty(device(), RTC_DEVICE_PROPERTY_VERSION_PATCH)));
}

namespace {

// A ray's way through the tiles, nearest first. Rays that cross more tiles than fit here start again where they
// stopped.
struct Itinerary {
  static constexpr uint32_t kRoom = 12;
  uint32_t tile[kRoom];
  double enter[kRoom];
  uint32_t count = 0, next = 0;
  bool more = false;

  using Open = std::vector<TileBvh::Entry>;
  void plan(const TileBvh& bvh, const Ray& ray, double t_max, Open& open) {
    count = next = 0;
    more = false;
    bvh.walk(ray, t_max, open, [&](uint32_t index, double at) { note(index, at, t_max); });
  }

  // The next tiles of a ray that crosses more than fit: all are listed again and those it has been through, which are
  // the nearest, are skipped.
  void go_on(const TileBvh& bvh, const Ray& ray, double t_max, Open& open) {
    const std::pair last{enter[count - 1], tile[count - 1]};
    count = next = 0;
    more = false;
    bvh.walk(ray, t_max, open, [&](uint32_t index, double at) {
      if (last < std::pair{at, index}) note(index, at, t_max);
    });
  }

 private:
  void note(uint32_t index, double at, double& t_max) {
    if (count == kRoom) {
      more = true;
      t_max = -1;
      return;
    }
    tile[count] = index;
    enter[count++] = at;
  }
};

using Waiting = std::pair<uint32_t, uint32_t>;  // (tile, ray)

// As far as the tile's hull can tell.
bool missed_by_all(const Tile& tile, std::span<const Waiting> here, std::span<const Ray> rays,
                   std::span<const double> reach) {
  return tile.hull.made() && std::none_of(here.begin(), here.end(), [&](const Waiting& one) {
           return tile.hull.meets(rays[one.second], reach[one.second]);
         });
}

}  // namespace

template <class Send>
void TileSet::pass(const World& world, std::span<const Ray> rays, std::span<double> reach, const Send& send) const {
  if (tiles.empty()) return;
  Packet packet;
  if (tiles.size() == 1) {
    Tile& only = *tiles[0];
    std::optional<InTile> inside;  // from the first packet on
    const auto send_on = [&] {
      if (!inside) inside.emplace(only, world);
      send(only, packet), packet.size = 0;
    };
    for (uint32_t i = 0; i < rays.size(); ++i) {
      double enter = 0, leave = 0;
      if (!clip(only.bounds, rays[i].origin, inverse_of(rays[i].direction), reach[i], enter, leave)) continue;
      packet.ray[packet.size] = i;
      packet.advance[packet.size] = enter;
      if (++packet.size == kWidth) send_on();
    }
    if (packet.size) send_on();
    return;
  }
  thread_local std::vector<Itinerary> ways;
  thread_local std::vector<Waiting> waiting;
  thread_local Itinerary::Open open;
  ways.resize(std::max(ways.size(), rays.size()));
  for (uint32_t i = 0; i < rays.size(); ++i) ways[i].plan(bvh, rays[i], reach[i], open);
  for (;;) {
    waiting.clear();
    for (uint32_t i = 0; i < rays.size(); ++i) {
      Itinerary& way = ways[i];
      if (way.next == way.count && way.more && reach[i] > 0) way.go_on(bvh, rays[i], reach[i], open);
      if (way.next < way.count && way.enter[way.next] <= reach[i])
        waiting.emplace_back(way.tile[way.next], i);
      else
        way.next = way.count;
    }
    if (waiting.empty()) return;
    std::stable_sort(waiting.begin(), waiting.end(), [](auto& a, auto& b) { return a.first < b.first; });
    for (size_t w = 0; w < waiting.size();) {
      Tile& tile = *tiles[waiting[w].first];
      size_t end = w;
      while (end < waiting.size() && waiting[end].first == waiting[w].first) ++end;
      // All rays go in or none: packets, and with them last bits, are what they are without a limit.
      if (missed_by_all(tile, std::span(waiting).subspan(w, end - w), rays, reach)) {
        for (; w < end; ++w) ++ways[waiting[w].second].next;
        continue;
      }
      const InTile inside(tile, world);
      for (; w < end; ++w) {
        const uint32_t i = waiting[w].second;
        packet.ray[packet.size] = i;
        packet.advance[packet.size] = ways[i].enter[ways[i].next++];
        if (++packet.size == kWidth) send(tile, packet), packet.size = 0;
      }
      if (packet.size) send(tile, packet), packet.size = 0;
    }
  }
}

// Of a periodic scene surfaces without bounds are no part of the cell: they are met once, by the whole ray.
static std::span<const uint32_t> unbounded_of(const World& world) {
  return world.periodic ? std::span<const uint32_t>{} : world.unbounded;
}

// reach: how far each ray may go on entry, where it was stopped on return.
void Tracer::nearest_in_tiles(std::span<const Ray> rays, std::span<double> reach, std::span<Hit> hits, bool coherent,
                              TraceStatistics& s) const {
  for (Hit& hit : hits) hit.object = kNone;
  s.rays += rays.size();
  const auto trace = [&](const TileSet& set, std::span<const uint32_t> unbounded, const MovingPart* moving) {
    PacketTracer tracer(*world_, moving, rays, reach, coherent, s);
    tracer.begin();
    for (const uint32_t object : unbounded) tracer.unbounded(object, {});
    set.pass(*world_, rays, reach, [&](const Tile& tile, const Packet& packet) { tracer.nearest(tile, packet); });
    tracer.finish(hits);
  };
  trace(world_->tiles, unbounded_of(*world_), nullptr);
  if (moving_) trace(moving_->tiles, moving_->unbounded, moving_.get());
}

void Tracer::occluded_in_tiles(std::span<const Ray> rays, std::span<double> reach, std::span<uint8_t> blocked,
                               bool coherent, TraceStatistics& s) const {
  std::fill(blocked.begin(), blocked.end(), uint8_t{0});
  s.rays += rays.size();
  const auto trace = [&](const TileSet& set, std::span<const uint32_t> unbounded, const MovingPart* moving) {
    PacketTracer tracer(*world_, moving, rays, reach, coherent, s);
    for (const uint32_t object : unbounded) tracer.unbounded(object, blocked);
    set.pass(*world_, rays, reach,
             [&](const Tile& tile, const Packet& packet) { tracer.occluded(tile, packet, blocked); });
  };
  trace(world_->tiles, unbounded_of(*world_), nullptr);
  if (moving_) trace(moving_->tiles, moving_->unbounded, moving_.get());
}

// What the walk through the cells did not hit, or hit behind it.
void Tracer::nearest_unbounded(std::span<const Ray> rays, std::span<Hit> hits, TraceStatistics& s) const {
  const Periodic& cell = *world_->periodic;
  std::vector<double> reach(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) reach[i] = hits[i].hit() ? hits[i].distance : INFINITY;
  PacketTracer tracer(*world_, nullptr, rays, reach, false, s);
  tracer.begin();
  for (const uint32_t object : world_->unbounded) tracer.unbounded(object, {});
  tracer.finish(hits);
  for (const uint32_t object : world_->unbounded)
    for (uint32_t i = 0; i < rays.size(); ++i) {
      if (hits[i].object != world_->flat.number(object)) continue;
      Vec3& p = hits[i].position;
      p.x -= std::floor((p.x - cell.low.x) / cell.size.x) * cell.size.x;
      p.y -= std::floor((p.y - cell.low.y) / cell.size.y) * cell.size.y;
    }
}

void Tracer::nearest(std::span<const Ray> rays, std::span<Hit> hits, bool coherent, TraceStatistics& s) const {
  thread_local std::vector<double> reach;
  thread_local CellWalk walk;
  if (!world_->periodic) {
    reach.assign(rays.size(), INFINITY);
    return nearest_in_tiles(rays, reach, hits, coherent, s);
  }
  std::fill(hits.begin(), hits.end(), Hit{});
  walk.start(*world_->periodic, bounds_, rays, {});
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
  if (!world_->unbounded.empty()) nearest_unbounded(rays, hits, s);
}

void Tracer::add_all(const Ray& ray, double length, std::vector<Hit>& hits, TraceStatistics& s) const {
  ++s.rays;
  double reach = length;
  const auto trace = [&](const TileSet& set, std::span<const uint32_t> unbounded, const MovingPart* moving) {
    PacketTracer tracer(*world_, moving, {&ray, 1}, {&reach, 1}, false, s);
    for (const uint32_t object : unbounded) tracer.all_unbounded(object, hits);
    set.pass(*world_, {&ray, 1}, {&reach, 1},
             [&](const Tile& tile, const Packet& packet) { tracer.all(tile, packet, hits); });
  };
  trace(world_->tiles, unbounded_of(*world_), nullptr);
  if (moving_) trace(moving_->tiles, moving_->unbounded, moving_.get());
}

bool Tracer::tells_all() const { return world_->all_hits; }

// Rays that end on the far side of a cell meet what stands at the near side of the next one, too.
void Tracer::all(const Ray& ray, double length, std::vector<Hit>& hits, TraceStatistics& s) const {
  SUITE_CHECK(world_->all_hits);
  hits.clear();
  add_all(ray, length, hits, s);
  if (world_->periodic) {
    const Periodic& cell = *world_->periodic;
    const double low[2] = {cell.low.x, cell.low.y}, size[2] = {cell.size.x, cell.size.y};
    double shift[2][2] = {};  // [axis]: none, and the one that brings it to the other side
    for (int a = 0; a < 2; ++a) {
      const double b = ray.origin[a], e = b + ray.direction[a] * length,
                   slack = 1e-6 * size[a] + 1e-6 * std::fabs(low[a]);
      if (std::min(b, e) <= low[a] + slack) shift[a][1] = size[a];
      if (std::max(b, e) >= low[a] + size[a] - slack) shift[a][1] = -size[a];
    }
    for (int x = 0; x < 2; ++x)
      for (int y = 0; y < 2; ++y) {
        if ((!x && !y) || (x && shift[0][1] == 0) || (y && shift[1][1] == 0)) continue;
        Ray moved = ray;
        moved.origin += Vec3{shift[0][x], shift[1][y], 0};
        add_all(moved, length, hits, s);
      }
    double reach = length;
    PacketTracer tracer(*world_, nullptr, {&ray, 1}, {&reach, 1}, false, s);
    for (const uint32_t object : world_->unbounded) tracer.all_unbounded(object, hits);
  }
  std::stable_sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.object < b.object;
  });
}

void Tracer::occluded(std::span<const Ray> rays, std::span<const double> distance, std::span<uint8_t> blocked,
                      bool coherent, TraceStatistics& s) const {
  thread_local std::vector<double> reach;
  thread_local CellWalk walk;
  if (!world_->periodic) {
    reach.assign(distance.begin(), distance.end());
    return occluded_in_tiles(rays, reach, blocked, coherent, s);
  }
  std::fill(blocked.begin(), blocked.end(), uint8_t{0});
  walk.start(*world_->periodic, bounds_, rays, distance);
  thread_local std::vector<uint8_t> found;
  while (walk.next(reach)) {
    found.resize(walk.rays().size());
    occluded_in_tiles(walk.rays(), reach, found, coherent, s);
    for (size_t i = 0; i < found.size(); ++i)
      if (found[i]) blocked[walk.owner(i)] = 1, walk.stop(i);
    walk.advance();
  }
  if (world_->unbounded.empty()) return;
  std::vector<double> whole(distance.begin(), distance.end());
  PacketTracer tracer(*world_, nullptr, rays, whole, coherent, s);
  for (const uint32_t object : world_->unbounded) tracer.unbounded(object, blocked);
}

}  // namespace suite
