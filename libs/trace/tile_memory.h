// A limit for what acceleration structures take: tiles that no ray came to for longest are given up, and built anew
// when one comes again. Internal.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <vector>

#include "trace/tracer.h"

namespace suite {

struct Tile;
struct TileSet;
struct World;

// Whether a tile is built, and how many threads are inside it.
class TileState {
 public:
  bool built() const { return value_.load(std::memory_order_relaxed) & kBuilt; }

 private:
  friend class TileMemory;
  static constexpr uint32_t kBuilt = 1u << 31;
  std::atomic<uint32_t> value_{0};  // threads inside, and kBuilt
  std::atomic<uint64_t> used_{0};   // TileMemory::now_ when a ray last came
  bool being_built_ = false;        // this and what follows under the memory's lock
  uint32_t waiting_ = 0;            // threads that want it
  uint32_t granted_ = 0;            // threads that waited and may go on: they are counted as inside, unless:
  std::exception_ptr fault_;        // it could not be built
  uint64_t geometry_ = 0;           // bytes of its arrays that are counted with it
};

// Bytes that the structures of a tile take while they are built, as far as is known before; and those of the arrays
// that they stand on: of mapped ones, which can be let go, or of all. What it shares with other tiles is counted, too.
enum class Arrays { mapped, all };
uint64_t structures_of(const Tile& tile, const World& world);
uint64_t geometry_of(const Tile& tile, const World& world, Arrays of);
// The same of what shared groups place, which stays once it is built.
uint64_t structures_of_groups(const World& world);
uint64_t geometry_of_groups(const World& world, Arrays of);

class TileMemory {
 public:
  TileMemory(const TileLimit& limit, const World& world);
  TileMemory(const TileMemory&) = delete;
  TileMemory& operator=(const TileMemory&) = delete;

  // The tile is built on return, and stays until leave(). A thread is inside one tile at a time, so that whoever waits
  // for room gets it. Error: what a mesh's arrays bring up.
  void enter(Tile& tile);
  void leave(Tile& tile);
  // What shared groups place is never given up: their structures call those of its meshes.
  void keep_meshes_of_groups();
  // A thread begins or ends work that asks for rays. While more of them can go on than there are cores, tiles that are
  // not there wait, and the one that most threads wait for is built first: many threads make few buildings.
  void begin_work();
  void end_work();
  // Its tiles end, and nobody is inside them.
  void forget(const TileSet& tiles);
  TileUse use() const;

 private:
  void enter_slowly(Tile& tile);
  Tile* most_wanted();
  void build(Tile& tile, const TileState& own, std::unique_lock<std::mutex>& lock);
  bool wait_for_turn(uint64_t bytes, const TileState& own, std::unique_lock<std::mutex>& lock);
  bool make_room(uint64_t bytes, const Tile& tile, const TileState& own, std::unique_lock<std::mutex>& lock);
  std::exception_ptr build_in(Tile& tile, std::unique_lock<std::mutex>& lock);
  void tell(uint64_t bytes, const Tile& tile);
  bool drop_one();
  void drop(Tile& tile);
  void release_meshes(const std::vector<uint32_t>& meshes);
  const TileLimit limit_;
  const World& world_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;  // a tile was built or could not be, or a thread stopped
  const int cores_;
  int working_ = 0, blocked_ = 0;  // threads between begin_work() and end_work(); those that wait for a tile
  int building_ = 0;               // threads that build
  std::vector<Tile*> wanted_;      // that somebody waits for and nobody builds
  std::atomic<uint64_t> now_{1};   // builds so far
  std::vector<Tile*> built_;
  std::vector<uint32_t> users_;  // of each mesh: tiles that are built or being built and share its structure
  uint64_t geometry_ = 0;        // bytes of the arrays of tiles that are built or being built
  uint64_t hulls_ = 0;           // bytes of the hulls of all tiles that have one, which stay
  uint64_t promised_ = 0;        // bytes for those being built, or that room is being made for
  bool told_ = false;
  TileUse use_;
};

// Stays inside a tile, which is built.
class InTile {
 public:
  InTile(Tile& tile, const World& world);
  ~InTile();
  InTile(const InTile&) = delete;
  InTile& operator=(const InTile&) = delete;

 private:
  Tile& tile_;
  TileMemory* memory_;  // null: no limit
};

}  // namespace suite
