// The ground that pixels of a picture cover, shared out among the cells of a north-up grid (conservative resampling).
//
// A footprint is the quadrilateral between the middles of the places of a pixel and its neighbours; where a neighbour
// is torn off (the edge of a roof, what is hidden behind it) it ends half-way to where the neighbour would be. Where
// several pixels cover a cell at different heights (a bridge and what is seen beneath it), the upper ones count, as in
// a view from straight above. A wall has no area on the map, and does not count.
//
// Based on: P. W. Jones, "First- and second-order conservative remapping schemes for grids in spherical coordinates",
// Mon. Weather Rev. 127, 1999 (weights by overlapping areas, first order); I. Sutherland, G. Hodgman, "Reentrant
// polygon clipping", CACM 17(1), 1974.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "sensor/ground_grid.h"

namespace suite {

class Footprints {
 public:
  struct Share {
    uint32_t pixel = 0;
    float area = 0;  // of the cell
  };
  // places: row-major, one a pixel, NaN = unknown; heights_m: of each. unit_m: what the grid's unit stands for.
  Footprints(std::span<const Vec2> places, std::span<const double> heights_m, uint32_t columns, const GroundGrid& grid,
             double unit_m);
  // The pixels that a cell shows; none where less than half of it is seen.
  std::span<const Share> cell(size_t i) const { return std::span(shares_).subspan(begin_[i], count_[i]); }

 private:
  std::vector<Share> shares_;
  std::vector<size_t> begin_;
  std::vector<uint32_t> count_;
};

}  // namespace suite
