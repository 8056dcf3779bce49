// The sky as a place under level water sees it: directions above the water, with densities that follow the radiance
// times the cosine of the zenith angle and what water lets through, one for each of a state's knots, so that paths
// share them among knots as they do all other densities.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/kinds/sky.h"

namespace suite {

class SkyThroughWater {
 public:
  // Weights of directions, relative ones, as Sky takes its tables: one for each knot.
  explicit SkyThroughWater(const std::vector<SkySpec>& knots);
  // Density 0: at that knot the sky is black.
  DirectionSample draw(size_t knot, Vec2 u) const;
  // 1/sr, for all knots.
  void densities(Dir direction, std::span<double> density) const;

 private:
  std::vector<Sky> knots_;
};

}  // namespace suite
