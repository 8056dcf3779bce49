#include "scene/point_voxels.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace suite {

namespace {

constexpr double kMostCells = 1 << 28, kCellsOfPoint = 1000;

struct Grid {
  Vec3 low;
  double cell_m;
  std::array<uint32_t, 3> cells;

  // Which cell along an axis; may be outside.
  long long along(Vec3 p, int c) const { return static_cast<long long>(std::floor((p[c] - low[c]) / cell_m)); }
  bool in_column(Vec3 p, size_t& column) const {
    const long long i = along(p, 0), j = along(p, 1);
    if (i < 0 || j < 0 || i >= cells[0] || j >= cells[1]) return false;
    column = static_cast<size_t>(i) + cells[0] * static_cast<size_t>(j);
    return true;
  }
  size_t columns() const { return size_t{cells[0]} * cells[1]; }
};

Grid grid_of(std::span<const Vec3> places, const std::vector<bool>& leaf, double cell_m) {
  Box3 box;
  size_t count = 0;
  for (size_t k = 0; k < places.size(); ++k)
    if (leaf[k]) box.grow(places[k]), ++count;
  if (!count) throw Error("no point is of one of these classes");
  Grid grid{{}, cell_m, {}};
  double cells = 1;
  for (int c = 0; c < 3; ++c) {
    grid.low[c] = std::floor(box.low[c] / cell_m) * cell_m;
    const double n = std::floor((box.high[c] - grid.low[c]) / cell_m) + 1;
    cells *= n;
    grid.cells[static_cast<size_t>(c)] = n < 4e9 ? static_cast<uint32_t>(n) : 0;
  }
  if (!(cells <= kMostCells && cells <= kCellsOfPoint * static_cast<double>(count)))
    throw Error(strf("%g cells of %g m for %zu points", cells, cell_m, count),
                strf("at most %g, and %g for each point: use larger cells", kMostCells, kCellsOfPoint));
  return grid;
}

// Points of anything below the lowest cells, and those between that are no leaves.
struct Counts {
  std::vector<uint32_t> leaves, others, below;
};

Counts counts_of(std::span<const Vec3> places, const std::vector<bool>& leaf, const Grid& grid) {
  const size_t columns = grid.columns();
  Counts counts;
  counts.leaves.assign(columns * grid.cells[2], 0);
  counts.others.assign(columns * grid.cells[2], 0);
  counts.below.assign(columns, 0);
  for (size_t k = 0; k < places.size(); ++k) {
    size_t column = 0;
    if (!finite(places[k]) || !grid.in_column(places[k], column)) continue;
    const long long layer = grid.along(places[k], 2);
    if (layer >= grid.cells[2]) continue;
    if (layer < 0)
      ++counts.below[column];
    else
      ++(leaf[k] ? counts.leaves : counts.others)[column + columns * static_cast<size_t>(layer)];
  }
  return counts;
}

}  // namespace

PointVoxels point_voxels(std::span<const Vec3> places, const std::vector<bool>& leaf, double cell_m, PointRule rule,
                         double projection) {
  const Grid grid = grid_of(places, leaf, cell_m);
  const Counts counts = counts_of(places, leaf, grid);
  PointVoxels made;
  made.cells = grid.cells;
  made.to_local = translation(grid.low) * scaling({cell_m, cell_m, cell_m});
  made.density.resize(counts.leaves.size());
  if (rule == PointRule::counts) {
    for (size_t k = 0; k < made.density.size(); ++k)
      made.density[k] = static_cast<float>(counts.leaves[k] / (cell_m * cell_m * cell_m));
    return made;
  }
  const size_t columns = grid.columns();
  for (size_t column = 0; column < columns; ++column) {
    double through = counts.below[column];
    for (size_t layer = 0; layer < grid.cells[2]; ++layer) {
      const size_t cell = column + columns * layer;
      // Within a cell what is no leaf lies behind its leaves.
      through += counts.others[cell];
      const double stayed = counts.leaves[cell];
      if (stayed > 0) {
        made.opaque += through == 0;
        const double passed = std::max(through, 0.5);
        made.density[cell] = static_cast<float>(std::log((passed + stayed) / passed) / (projection * cell_m));
      }
      through += stayed;
    }
  }
  return made;
}

}  // namespace suite
