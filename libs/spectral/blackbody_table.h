// Blackbody radiance of the bins of a spectral state at any temperature of a range, for surfaces whose temperature
// differs from point to point: the exact band radiance is too slow to be asked at every hit.
//
// Method: ln of the bin's mean radiance is tabulated over ln T and interpolated by Lagrange cubics, relative error
// below 1e-5 from 0.3 to 1000 um and 1 to 1e5 K where the radiance is above 1e-40
// (tests/unit/surface/map_lookup_test.cpp).
#pragma once
#include <span>
#include <vector>

#include "spectral/state.h"

namespace suite {

class BlackbodyTable {
 public:
  // 0 < low_k <= high_k, the temperatures it will be asked for; it clamps to them.
  BlackbodyTable(std::span<const Bin> bins, double low_k, double high_k);
  // Spectral radiance W/(m2 sr um), the mean of each bin; out has as many values as there are bins.
  void radiance(double kelvin, std::span<float> out) const;
  double low_k() const { return low_; }
  double high_k() const { return high_; }

 private:
  size_t bins_ = 0;
  double low_, high_, first_;     // first_: ln T of row 0
  std::vector<float> logarithm_;  // rows over ln T, one step of 1/32 apart; bins
};

}  // namespace suite
