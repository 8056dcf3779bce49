// What a ray can be told of a tile that is not there: a pyramid of boxes around what the tile holds. A tile under a
// limit of memory is not built for rays that meet none of them. Internal.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

class Tracer;
struct Tile;
struct World;

class TileHull {
 public:
  // Cells along a side of the grid, over the two axes along which the tile is widest, at the most; tiles that hold
  // little have fewer, so that hulls, which stay, take some bytes a triangle at the most.
  static constexpr uint32_t kMostEdge = 32;
  struct Cell {
    std::array<float, 3> low, high;  // m from the tile's origin; low > high: empty
    bool empty() const { return !(low[0] <= high[0]); }
  };

  // Once, while the tile is built, so that its arrays are there. Other threads may ask for made() meanwhile.
  void make(const Tile& tile, const World& world);
  bool made() const { return made_.load(std::memory_order_acquire); }
  // Whether a ray (ENU) meets a box before t_max, m. False: nothing in the tile can be hit, nor seen by float rays.
  bool meets(const Ray& ray, double t_max) const;
  Vec3 origin() const { return origin_; }  // of the tile, ENU
  // Of the lowest level.
  std::span<const Cell> cells() const { return std::span(levels_).last(size_t{edge_} * edge_); }
  uint64_t bytes() const { return levels_.capacity() * sizeof(Cell); }

 private:
  Vec3 origin_;
  uint32_t edge_ = 1;         // of the lowest level, a power of two
  std::vector<Cell> levels_;  // [level][row][column], from one box around all to edge_ x edge_
  std::atomic<bool> made_{false};
};

// Of a tracer's tiles, what is at rest first; of those that have one.
std::vector<const TileHull*> hulls_of(const Tracer& tracer);

}  // namespace suite
