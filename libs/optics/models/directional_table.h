// Numbers tabulated over the outgoing direction when a model is baked: directional totals that have no closed form.
//
// Rows run over (sqrt(2) sin(theta / 2) + v) / 2 with v = 1 - 1 / sqrt(1 + s), s = sqrt(ax^2 x^2 + ay^2 y^2) / |z|:
// nearly the polar angle, which Fresnel's equations follow, and the tangent in units of the roughness, which shadowing
// follows; columns over the azimuth in the first quadrant (one when isotropic). Every entry holds `width` numbers.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

class DirectionalTable {
 public:
  DirectionalTable() = default;
  // fill(direction, entry), called from several threads: the width numbers of a direction with z > 0 in the first
  // quadrant. rows >= 2. The last row is filled 1e-5 rad from the horizon.
  DirectionalTable(double ax, double ay, size_t rows, size_t width,
                   const std::function<void(Dir, std::span<float>)>& fill);
  // Cubic (Catmull-Rom) along rows, linear along azimuth; out.z > 0. out_values.size() == width.
  void at(Dir out, std::span<float> out_values) const;
  float at(Dir out, size_t index) const { return at(locate(out), index); }

  // Where a direction lies, for those who ask for several numbers of one direction.
  struct Place {
    size_t entry[8];
    double weight[8];
    int count;
  };
  Place locate(Dir out) const;
  float at(const Place& place, size_t index) const;

 private:
  double coordinate(double theta, double roughness) const;  // of the rows, 0 to 1
  double ax_ = 1, ay_ = 1;
  size_t rows_ = 0, columns_ = 0, width_ = 0;
  std::vector<float> values_;
};

}  // namespace suite
