// What the runtime of the aligned method looks up: leaves with their planes and masses, cumulative masses to draw from.
// Built once from decoded trees. Internal to libs/sqt; the method is described in aligned.h.
//
// Leaf, view and channel share four numbers (value, two slopes, mass), so that eval and pdf touch the same lines of
// cache; all channels of a view stand side by side, so that those are few. Of a column (channel, view), the mass of a
// leaf is a whole number that follows from its code and the column's scale; cumulative masses are sums of the same
// numbers: pdf is what sample does.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sqt/aligned.h"
#include "sqt/leaf_table.h"
#include "sqt/tree.h"

namespace suite::sqt {

// Error naming the first invariant that does not hold.
void check_aligned(const AlignedData& data);

class AlignedTables {
 public:
  struct Sheet {
    Tree tree;
    LogScale scale;
    UnsetVector<int16_t> plane;       // [leaf][view][channel]{value, slope x, slope y, mass}
    std::vector<float> inverse_area;  // 1/sr of one leaf, its mirror image counted in
    size_t first = 0;                 // index of the first leaf among all sheets
  };
  AlignedTables() = default;
  AlignedTables(const AlignedLayout& layout, std::vector<AlignedSheet> sheets);

  const std::vector<Sheet>& sheets() const { return sheets_; }
  size_t leaves() const { return leaves_; }

  // Probability of a leaf, from the code of its mass; column: channel x views + view.
  float probability(size_t column, int16_t code) const {
    const Column& c = columns_[column];
    return static_cast<float>(static_cast<int32_t>(mass_of(static_cast<uint16_t>(code)) * c.scale)) * c.inverse_total;
  }
  bool empty(size_t column) const { return columns_[column].total == 0; }
  // Drawing a leaf.
  struct Draw {
    size_t leaf;    // among all sheets
    double within;  // where in the leaf's share `u` fell, [0, 1)
  };
  Draw draw(size_t column, double u) const;  // u in [0, 1); the column is not empty

 private:
  static constexpr size_t kTile = 64;  // leaves whose sums lie together
  struct Column {
    float scale = 0, inverse_total = 0;
    int32_t total = 0;  // of the whole masses, below 2^31
  };
  void put_in_order(const std::vector<AlignedSheet>& sheets);
  std::vector<double> sum_masses(const std::vector<AlignedSheet>& sheets) const;
  void accumulate(const std::vector<AlignedSheet>& sheets, size_t begin, size_t end);
  std::vector<Sheet> sheets_;
  size_t leaves_ = 0, tiles_ = 0, row_ = 0;
  std::vector<uint32_t> order_;      // leaves as they are drawn
  std::vector<Column> columns_;      // padded_row of them
  UnsetVector<int32_t> cumulative_;  // [tile][column][leaf of the tile]: mass of the leaves before
  UnsetVector<int32_t> tile_sum_;    // [column][tile, and one more]: mass of the tiles before
};

}  // namespace suite::sqt
