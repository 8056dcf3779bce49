// A picture whose pixels are known places on a map, looked up from a north-up grid: for every cell the pixel that shows
// it (a geographic lookup table). Nothing is interpolated: cells take numbers of pixels, so that any image of the same
// sensor can be put on the map.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

struct GroundGrid {
  double west = 0, north = 0, cell = 0;  // m: outer corner of the first cell, edge of a cell; a multiple of `cell`
  uint32_t columns = 0, rows = 0;
  // Per cell, row-major from the north-west: sample and line of the picture, from 1; negative where no pixel lies in
  // the cell and the nearest of those around it is taken; 0 where the picture does not show the cell.
  std::vector<int32_t> sample, line;
};

// The distance between neighbours in a picture: medians along lines and across them; 0 where there are no neighbours.
struct Spacing {
  double along_line = 0, across = 0;
  // The edge of a square of a pixel's area, to two digits; 0 when nothing is known of it.
  double pixel() const;
};
// places: row-major, one a pixel, NaN = unknown.
Spacing spacing_of(std::span<const Vec2> places, uint32_t columns);

inline constexpr size_t kMostCells = size_t{1} << 27;
// Of the pixels in a cell the one nearest to its middle is taken. Cells without one are filled where four (or three)
// neighbours around them lie no further apart than kFarthest times what is usual, so that what is hidden behind edges
// stays empty. Nothing when no place is known. Error: cell not positive, more than kMostCells cells.
inline constexpr double kFarthest = 4;
std::optional<GroundGrid> ground_grid(std::span<const Vec2> places, uint32_t columns, double cell);

}  // namespace suite
