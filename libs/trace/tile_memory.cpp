#include "trace/tile_memory.h"

#include <algorithm>
#include <chrono>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "trace/embree_internal.h"

namespace suite {

namespace {

// What Embree takes while it builds, at its most: 60 to 90 bytes a triangle are kept, and lists of them while they are
// sorted, whose number grows where triangles are split (measured with 3.13.5, high quality, robust).
constexpr uint64_t kTriangle = 130, kInstance = 160, kScene = 32 << 10;

// Bytes that Embree holds, of all scenes of the process.
std::atomic<int64_t> embree_bytes{0}, embree_most{0};

bool count(void*, ssize_t bytes, bool) {
  const int64_t now = embree_bytes.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  for (int64_t most = embree_most.load(std::memory_order_relaxed);
       now > most && !embree_most.compare_exchange_weak(most, now, std::memory_order_relaxed);) {
  }
  return true;
}

uint64_t embree_now() { return static_cast<uint64_t>(std::max<int64_t>(0, embree_bytes.load())); }

// Meshes whose structure a tile shares with other instances, each once.
std::vector<uint32_t> shared_meshes(const Tile& tile, const World& world) {
  std::vector<uint32_t> meshes;
  for (const auto& set : tile.sets)
    for (const uint32_t i : set->objects)
      if (const uint32_t m = world.flat.objects[i].mesh; m != kNone) meshes.push_back(m);
  std::sort(meshes.begin(), meshes.end());
  meshes.erase(std::unique(meshes.begin(), meshes.end()), meshes.end());
  return meshes;
}

std::vector<uint32_t> meshes_of_groups(const World& world) {
  std::vector<uint32_t> meshes;
  for (const SharedGroup& group : world.flat.groups)
    for (const TracedObject& o : group.objects)
      if (o.mesh != kNone) meshes.push_back(o.mesh);
  std::sort(meshes.begin(), meshes.end());
  meshes.erase(std::unique(meshes.begin(), meshes.end()), meshes.end());
  return meshes;
}

uint64_t counted(const Mesh& mesh, Arrays of) { return of == Arrays::all || mesh.stored ? mesh.bytes() : 0; }

const Mesh& direct_mesh(const World& world, uint32_t object) {
  return world.scene->meshes[world.flat.objects[object].mesh];
}

}  // namespace

TileMemory::TileMemory(const TileLimit& limit, const World& world)
    : limit_(limit), world_(world), cores_(threads()), users_(world.scene->meshes.size()) {
  // Once for all: what has been counted as taken must be counted when it goes.
  static const bool counting = [] {
    rtcSetDeviceMemoryMonitorFunction(device(), count, nullptr);
    return true;
  }();
  (void)counting;
}

uint64_t structures_of(const Tile& tile, const World& world) {
  uint64_t triangles = 0, instances = 0;
  for (const uint32_t object : tile.direct) triangles += direct_mesh(world, object).triangle_count();
  for (const auto& set : tile.sets) instances += set->objects.size();
  for (const uint32_t m : shared_meshes(tile, world)) triangles += world.scene->meshes[m].triangle_count();
  return kScene + kTriangle * triangles + kInstance * instances;
}

uint64_t geometry_of(const Tile& tile, const World& world, Arrays of) {
  uint64_t bytes = 0;
  const auto add = [&](const Mesh& mesh) { bytes += counted(mesh, of); };
  for (const uint32_t object : tile.direct) add(direct_mesh(world, object));
  for (const uint32_t m : shared_meshes(tile, world)) add(world.scene->meshes[m]);
  return bytes;
}

uint64_t structures_of_groups(const World& world) {
  uint64_t bytes = 0;
  for (const SharedGroup& group : world.flat.groups) bytes += kScene + kInstance * group.objects.size();
  for (const uint32_t m : meshes_of_groups(world)) bytes += kTriangle * world.scene->meshes[m].triangle_count();
  return bytes;
}

uint64_t geometry_of_groups(const World& world, Arrays of) {
  uint64_t bytes = 0;
  for (const uint32_t m : meshes_of_groups(world)) bytes += counted(world.scene->meshes[m], of);
  return bytes;
}

void TileMemory::keep_meshes_of_groups() {
  for (const uint32_t m : meshes_of_groups(world_)) ++users_[m];
}

void TileMemory::enter(Tile& tile) {
  TileState& state = tile.state;
  state.used_.store(now_.load(std::memory_order_relaxed), std::memory_order_relaxed);
  if (state.value_.fetch_add(1, std::memory_order_acquire) & TileState::kBuilt) return;
  state.value_.fetch_sub(1, std::memory_order_relaxed);
  enter_slowly(tile);
}

void TileMemory::leave(Tile& tile) { tile.state.value_.fetch_sub(1, std::memory_order_release); }

void TileMemory::begin_work() {
  const std::lock_guard lock(mutex_);
  ++working_;
}

void TileMemory::end_work() {
  const std::lock_guard lock(mutex_);
  --working_;
  changed_.notify_all();
}

// Whoever waits builds what is wanted most, be it another's tile, as soon as too few threads can go on.
void TileMemory::enter_slowly(Tile& tile) {
  TileState& state = tile.state;
  std::unique_lock lock(mutex_);
  if (state.built()) {  // tiles are dropped under the lock only
    state.value_.fetch_add(1, std::memory_order_acquire);
    return;
  }
  if (state.waiting_++ == 0 && !state.being_built_) wanted_.push_back(&tile);
  ++blocked_;
  changed_.notify_all();
  while (state.granted_ == 0) {
    Tile* const wanted = working_ - blocked_ < cores_ ? most_wanted() : nullptr;
    if (wanted)
      build(*wanted, state, lock);
    else
      changed_.wait(lock);
  }
  const std::exception_ptr fault = state.fault_;
  if (--state.granted_ == 0) state.fault_ = nullptr;
  if (fault) std::rethrow_exception(fault);
}

// Taken off the list.
Tile* TileMemory::most_wanted() {
  const auto most = std::max_element(wanted_.begin(), wanted_.end(), [](const Tile* a, const Tile* b) {
    return a->state.waiting_ < b->state.waiting_;
  });
  // One whose last waiters are still being told of a fault has to wait for them.
  if (most == wanted_.end() || (*most)->state.granted_) return nullptr;
  Tile* const tile = *most;
  wanted_.erase(most);
  return tile;
}

// own: the tile that this thread itself waits for.
void TileMemory::build(Tile& tile, const TileState& own, std::unique_lock<std::mutex>& lock) {
  TileState& state = tile.state;
  state.being_built_ = true;
  --blocked_;  // this thread
  const uint64_t structures = structures_of(tile, world_);
  state.geometry_ = geometry_of(tile, world_, Arrays::mapped);
  bool room = wait_for_turn(structures, own, lock);
  if (room) {
    // Promised before there is room, so that of several who make room each sees what the others will take.
    promised_ += structures, geometry_ += state.geometry_;
    room = make_room(structures + state.geometry_, tile, own, lock);
    if (room) state.fault_ = build_in(tile, lock);
    promised_ -= structures;
    if (!room || state.fault_) geometry_ -= state.geometry_;
  }
  ++blocked_;
  state.being_built_ = false;
  if (!room) {
    wanted_.push_back(&tile);
    changed_.notify_all();
    return;
  }
  // All who wait go on and are inside, before anybody can drop it.
  state.granted_ = std::exchange(state.waiting_, 0);
  blocked_ -= static_cast<int>(state.granted_);
  if (!state.fault_) {
    built_.push_back(&tile);
    now_.fetch_add(1, std::memory_order_relaxed);
    state.used_.store(now_.load(std::memory_order_relaxed), std::memory_order_relaxed);
    state.value_.fetch_add(TileState::kBuilt + state.granted_, std::memory_order_release);
    ++use_.built;
    use_.most_tiles = std::max<uint64_t>(use_.most_tiles, built_.size());
    use_.most_geometry = std::max(use_.most_geometry, geometry_);
  }
  changed_.notify_all();
}

// Structures that are being built take twice what stays of them and keep other tiles out, so several at a time may take
// no more than an eighth of the limit. Whoever waits has chosen its tile before, so that one that few want is built,
// too. False: as make_room.
bool TileMemory::wait_for_turn(uint64_t bytes, const TileState& own, std::unique_lock<std::mutex>& lock) {
  while (promised_ > 0 && promised_ + bytes > limit_.bytes / 8) {
    if (own.granted_) return false;
    changed_.wait(lock);
  }
  return true;
}

// Drops what was not used for longest, until what is promised has room. Tiles with somebody inside are waited for. Who
// is inside one must wait for nothing, so a thread whose own tile has come meanwhile, and which may count as inside it,
// leaves the work to others: false.
bool TileMemory::make_room(uint64_t bytes, const Tile& tile, const TileState& own, std::unique_lock<std::mutex>& lock) {
  bool dropped = false;
  while (embree_now() + geometry_ + hulls_ + promised_ > limit_.bytes) {
    if (built_.empty() && building_ == 0) {
      tell(bytes, tile);
      break;
    }
    if (drop_one())
      dropped = true;
    else if (own.granted_)
      return false;
    else
      changed_.wait_for(lock, std::chrono::microseconds(200));
  }
  // Freed blocks lie among others; the allocator gives their pages back when asked.
  if (dropped) give_back_freed();
  return true;
}

void TileMemory::tell(uint64_t bytes, const Tile& tile) {
  if (!limit_.warn || std::exchange(told_, true)) return;
  const Vec3 middle = tile.bounds.center();
  limit_.warn(
      strf("the tile around %.0f, %.0f, %.0f m takes about %s by itself, more than the %s that tiles may take; it "
           "is held all the same, alone",
           middle.x, middle.y, middle.z, human_bytes(static_cast<double>(bytes)).c_str(),
           human_bytes(static_cast<double>(limit_.bytes)).c_str()));
}

// Without the lock meanwhile. What went wrong, or null.
std::exception_ptr TileMemory::build_in(Tile& tile, std::unique_lock<std::mutex>& lock) {
  const std::vector<uint32_t> meshes = shared_meshes(tile, world_);
  for (const uint32_t m : meshes) ++users_[m];
  const uint64_t before = tile.hull.bytes();  // of an earlier building
  ++building_;
  lock.unlock();
  std::exception_ptr fault;
  try {
    isolated([&] {
      tile.build(world_);
      tile.hull.make(tile, world_);
    });
  } catch (...) {
    fault = std::current_exception();
  }
  lock.lock();
  --building_;
  hulls_ += tile.hull.bytes() - before;
  if (!fault) return nullptr;
  tile.handle = SceneHandle();
  release_meshes(meshes);
  return fault;
}

bool TileMemory::drop_one() {
  std::sort(built_.begin(), built_.end(), [](const Tile* a, const Tile* b) {
    return a->state.used_.load(std::memory_order_relaxed) > b->state.used_.load(std::memory_order_relaxed);
  });
  for (size_t k = built_.size(); k-- > 0;) {
    uint32_t empty = TileState::kBuilt;
    Tile& tile = *built_[k];
    if (!tile.state.value_.compare_exchange_strong(empty, 0, std::memory_order_acq_rel)) continue;
    built_.erase(built_.begin() + static_cast<long>(k));
    drop(tile);
    ++use_.dropped;
    return true;
  }
  return false;
}

void TileMemory::drop(Tile& tile) {
  tile.handle = SceneHandle();
  geometry_ -= tile.state.geometry_;
  for (const uint32_t object : tile.direct) direct_mesh(world_, object).let_go();
  release_meshes(shared_meshes(tile, world_));
}

void TileMemory::release_meshes(const std::vector<uint32_t>& meshes) {
  for (const uint32_t m : meshes) {
    if (--users_[m]) continue;
    world_.meshes[m].once.undo();
    world_.meshes[m].handle = SceneHandle();
    world_.scene->meshes[m].let_go();
  }
}

void TileMemory::forget(const TileSet& set) {
  const std::lock_guard lock(mutex_);
  for (const auto& tile : set.tiles) {
    hulls_ -= tile->hull.bytes();
    if (const auto at = std::find(built_.begin(), built_.end(), tile.get()); at != built_.end()) {
      built_.erase(at);
      drop(*tile);
    }
  }
}

TileUse TileMemory::use() const {
  const std::lock_guard lock(mutex_);
  TileUse use = use_;
  use.most_structures = static_cast<uint64_t>(std::max<int64_t>(0, embree_most.load()));
  return use;
}

int Tracer::useful_threads() const {
  constexpr int kWaiting = 32;  // for each that runs
  return world_->memory ? kWaiting * threads() : threads();
}

AtWork::AtWork(const Tracer& tracer) : world_(tracer.world_) {
  if (world_->memory) world_->memory->begin_work();
}

AtWork::~AtWork() {
  if (world_->memory) world_->memory->end_work();
}

InTile::InTile(Tile& tile, const World& world) : tile_(tile), memory_(world.memory.get()) {
  if (memory_)
    memory_->enter(tile_);
  else
    tile_.once.run([&] { tile_.build(world); });
}

InTile::~InTile() {
  if (memory_) memory_->leave(tile_);
}

}  // namespace suite
