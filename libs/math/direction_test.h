// Do drawn directions follow a density? A histogram over cells of the sphere that adapt to where samples fall, and the
// density's integral over each cell.
//
// Based on: Pearson's chi-square test; adaptive Gauss quadrature (3 x 3 points).
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "math/vec.h"

namespace suite {

class DirectionHistogram {
 public:
  // pilot: directions drawn like the tested ones but from another stream; they shape about `cells` cells of similar
  // probability. May be empty: one cell a hemisphere.
  DirectionHistogram(const std::vector<Dir>& pilot, size_t cells);
  ~DirectionHistogram();
  DirectionHistogram(const DirectionHistogram&) = delete;
  DirectionHistogram& operator=(const DirectionHistogram&) = delete;

  void add(Dir d);
  struct Verdict {
    double p_value = 1;  // of how the added directions are spread, given their number (Pearson)
    int degrees = 0;
    double added = 0;  // number of directions
    double mass = 0;   // integral of the density over the sphere
  };
  // density per steradian, finite and >= 0; relative error of its integral about 1e-4 when the pilot holds thousands of
  // directions. samples: draws that were made, failed ones included.
  Verdict judge(const std::function<double(Dir)>& density, double samples) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace suite
