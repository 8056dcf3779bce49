// What a bundle knows of polarisation: Mueller matrices of a measured surface over their m11, on a grid of half-vector
// angles. Between nodes they are interpolated linearly, so that what lies between matrices that exist exists, too
// (planes through leaves, as trees have them, would leave what is possible).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/mueller.h"
#include "sqt/half_grid.h"

namespace suite::sqt {

class MuellerTable {
 public:
  static constexpr size_t kElements = 15;  // row-major, without m11
  static constexpr int kUnit = 32767;      // stands for 1
  // elements: [node][wavelength][kElements], between the bases (p, s, k) of the plane of scattering (math/mueller.h).
  struct Data {
    HalfGrid grid;
    std::vector<double> wavelength_um;  // ascending
    std::vector<int16_t> elements;
  };
  // Error: axes that do not ascend, or another number of elements.
  explicit MuellerTable(Data data);
  const Data& data() const { return data_; }
  // Matrices over m11, one a wavelength, in the plane of scattering of light from `in` to `out`, both above the
  // surface.
  void at(Dir out, Dir in, std::span<Mueller> m) const;
  // Least eigenvalue of the coherency matrices of all nodes (least_coherency).
  double least() const;

 private:
  Data data_;
};

}  // namespace suite::sqt
