// Piecewise-bilinear densities on the unit square, one slice per pair of parameters (phi_i, theta_i), interpolated
// linearly between slices, with the map from positions back to the uniform square.
// Based on: J. Dupuy & W. Jakob, "An adaptive parameterization for efficient material acquisition and rendering",
// ACM TOG 37(6), 2018, section 4 and its supplement (marginal-conditional warps).
#pragma once
#include <array>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite::rgl {

// Up to four slices and their weights.
struct SliceMix {
  std::array<size_t, 4> slice;
  std::array<double, 4> weight;
  int count = 0;
};

// Tables of `slices` x rows x columns, values at the corners of (rows - 1) x (columns - 1) patches of the unit square;
// x runs along columns, y along rows. rows, columns >= 2.
class Bilinear {
 public:
  Bilinear() = default;
  Bilinear(size_t rows, size_t columns, std::vector<float> values)
      : rows_(rows), columns_(columns), values_(std::move(values)) {}

  // Interpolated value; `channel` of `channels` lies between slice and rows in the table. Positions are clamped to the
  // square.
  double at(Vec2 p, const SliceMix& mix, size_t channels = 1, size_t channel = 0) const;

 private:
  size_t rows_ = 0, columns_ = 0;
  std::vector<float> values_;
};

class Warp {
 public:
  Warp() = default;
  // values as in Bilinear, >= 0; every slice is normalised to integrate to 1. A slice of zeros becomes uniform.
  Warp(size_t rows, size_t columns, std::span<const float> values);
  // Where in the uniform square the point p of the density comes from (conditional x, then marginal y).
  Vec2 invert(Vec2 p, const SliceMix& mix) const;

 private:
  size_t rows_ = 0, columns_ = 0;
  std::vector<float> density_;      // slices x rows x columns, in units of patches
  std::vector<float> conditional_;  // the same shape: integral along x from the left edge
  std::vector<float> marginal_;     // slices x rows: integral of the rows' integrals from the bottom
};

}  // namespace suite::rgl
