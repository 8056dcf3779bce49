// Densities on a grid from points that a laser scanner met.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

struct PointVoxels {
  std::array<uint32_t, 3> cells{0, 0, 0};
  Affine3 to_local;            // index space -> m
  std::vector<float> density;  // x fastest; counts: points in a m3; leaf_area: m2 in a m3
  size_t opaque = 0;           // leaf_area: cells with points below which there is none
};

enum class PointRule {
  // Points in a m3, whatever they are.
  counts,
  // Leaf area by contact frequency in each column of cells: of the points that came down to a cell some stayed there,
  // and their share is 1 - exp(-projection x density x height). Takes every point for one beam that came straight down,
  // and all that is not a leaf for what lies behind. Where nothing came through, half a point is taken to have. Based
  // on: R. A. MacArthur & H. S. Horn, "Foliage profile by vertical measurements", Ecology 50(5), 1969; as for scanners
  // A. Bouvier et al., "Generalizing predictive models of forest inventory attributes", Remote Sens. Environ. 156,
  // 2015.
  leaf_area,
};

// leaf: whether each place is of what fills the cells; the grid is the box of these, cell_m wide (> 0) and at multiples
// of it. projection: m2 of shadow of a m2 of leaves (0.5: they lie every way alike). Error: no such point, more than
// 2^28 cells or 1000 for each point.
PointVoxels point_voxels(std::span<const Vec3> places, const std::vector<bool>& leaf, double cell_m, PointRule rule,
                         double projection);

}  // namespace suite
