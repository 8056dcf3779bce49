// A ray's way through the cells of one voxel grid, nearest first, as stretches of constant contents. Everything in
// double.
//
// It goes from block of 8^3 cells to block, past those that hold nothing, and through the cells of a block; one whose
// cells are all alike is a single stretch. The planes between blocks are whole numbers, and their distances are
// computed afresh from those; only within a block they grow by one addition a cell. What rounding leaves is that of a
// few additions, however long the way is. Based on: J. Amanatides & A. Woo, "A fast voxel traversal algorithm for ray
// tracing", Eurographics 1987.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "motion/track.h"
#include "scene/scene.h"

namespace suite {

// What the blocks of a grid hold. Densities of blocks with cells that differ lie together, as rays meet them: 2 KB for
// each such block on top of the grid, and 4 bytes for each block.
struct GridBlocks {
  static constexpr int kBlock = 8;  // cells along an edge
  // In place of a number of a block of `densities`.
  static constexpr uint32_t kEmpty = kNone, kAlike = kNone - 1;
  std::array<uint32_t, 3> count{};
  std::array<double, 3> low{}, high{};  // box of the blocks that hold anything, in cells; low > high: none
  std::vector<uint32_t> kind;           // per block: kEmpty, kAlike (all cells alike) or its number among the others
  std::vector<float> densities;         // of the others: cell (i, j, k) at i + 8 (j + 8 k); 0 outside of the grid
  explicit GridBlocks(const VoxelGrid& grid);
  // The blocks of a grid; all that ask while somebody holds them share them. Any thread.
  static std::shared_ptr<const GridBlocks> of(const VoxelGrid& grid);

 private:
  void add(const VoxelGrid& grid, const std::array<uint32_t, 3>& corner);
};

// A voxel grid where it stands.
struct PlacedGrid {
  const VoxelGrid* grid = nullptr;
  Affine3 place{};               // index space -> ENU, or the moving body's axes
  const Track* track = nullptr;  // null: at rest
  Affine3 to_index{};            // ENU -> index space, of what is at rest
  std::shared_ptr<const GridBlocks> blocks{};
  bool emits = false;  // some cell has a temperature of its own

  Affine3 index_at(double time) const { return track ? (track->at(time).affine() * place).inverse() : to_index; }
  uint32_t medium(size_t cell) const { return grid->media[grid->kind.empty() ? 0 : grid->kind[cell]]; }
  double kelvin(size_t cell) const { return grid->temperature.empty() ? 0 : double{grid->temperature[cell]}; }
  // One medium at its own temperature.
  bool plain() const { return grid->kind.empty() && grid->temperature.empty(); }
};

class GridWalk {
 public:
  // To the first cell between begin and end, in metres along a ray with a unit direction, of a block that holds
  // anything; false when there is none. time: s, of the ray. Keeps a reference to the grid.
  bool start(const PlacedGrid& placed, Vec3 origin, Dir direction, double time, double begin, double end);
  bool ended() const { return ended_; }
  const PlacedGrid& placed() const { return *placed_; }
  // The current stretch, m; cell(): of the grid, one of those that it lies in.
  double begin() const { return begin_; }
  double end() const { return end_; }
  size_t cell() const;
  double density() const { return double{values_[at_.cell]}; }
  // To the next stretch.
  void advance();
  // Passes stretches, until density integrated over them would become more than `most` with the current one. Returns
  // the integral.
  double pass(double most);
  // Passes all that is left and adds the density integrated over it to depth[medium].
  void add_depths(std::span<double> depth);

 private:
  // Where the walk is in a block: distances of the planes through which the ray leaves the cell, m; the cell as an
  // index into values_; and how many steps the ray has taken on each axis, 8 bits each, counted so that the kBlock-th
  // leaves the block.
  struct Place {
    double plane[3];
    size_t cell;
    uint32_t taken;
  };
  static constexpr uint32_t kLeft = GridBlocks::kBlock * 0x010101u;  // bits of `taken` that tell of a block left
  static double nearest(const double* t) { return std::min(t[0], std::min(t[1], t[2])); }
  // Through the nearest plane. The branches cost less than a choice without them: rays to a lamp far away go alike.
  void step(Place& p) const {
    const double x = p.plane[0], y = p.plane[1], z = p.plane[2];
    if (x <= y && x <= z)
      step<0>(p);
    else if (y <= z)
      step<1>(p);
    else
      step<2>(p);
  }
  template <int A>
  void step(Place& p) const {
    p.plane[A] += gap_[A];
    p.cell += stride_[A];
    p.taken += 1u << (8 * A);
  }
  // Where the ray leaves cell p of the block, which it has entered at `begin`.
  double until(const Place& p, double begin) const { return std::min(std::max(nearest(p.plane), begin), block_end_); }
  bool clip(double begin, double end);
  void start_blocks();
  int next_block();
  void enter(Place& p);
  void cross(int axis, Place& p);
  void go_on(Place& p);
  size_t corner() const;  // the first cell of the block in the grid
  double first_plane(int axis, double number) const { return (number - origin_[axis]) * inverse_[axis]; }

  const PlacedGrid* placed_ = nullptr;
  const GridBlocks* blocks_ = nullptr;
  Vec3 origin_, direction_, inverse_;  // index space, parameter in metres of the ray; inverse: 0 = none
  double gap_[3];                      // m between planes
  size_t stride_[3], block_stride_[3];
  double begin_ = 0, leave_ = 0, block_end_ = 0, end_ = 0;
  // Blocks: number and distance of the plane through which the ray leaves the block on each axis, and how many blocks
  // are to come there.
  double far_[3], width_[3], plane_[3];
  int to_come_[3];
  size_t block_ = 0;
  uint32_t kind_ = GridBlocks::kEmpty;
  bool ended_ = true;
  const float* values_ = nullptr;  // densities in the block
  Place at_;
};

}  // namespace suite
