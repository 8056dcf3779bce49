#include "light/sky_through_water.h"

namespace suite {

SkyThroughWater::SkyThroughWater(const std::vector<SkySpec>& knots) {
  SpectralState one;
  one.low_um = 1, one.high_um = 1.1, one.reference_um = 1.05;
  one.bins = {{1, 1.1}};
  one.knots = {0};
  for (const SkySpec& knot : knots) knots_.emplace_back(knot, one);
}

DirectionSample SkyThroughWater::draw(size_t knot, Vec2 u) const {
  if (!knots_[knot].tabulated()) return {{0, 0, 1}, 0};
  return knots_[knot].draw(u);
}

void SkyThroughWater::densities(Dir direction, std::span<double> density) const {
  for (size_t k = 0; k < density.size(); ++k) density[k] = knots_[k].tabulated() ? knots_[k].density(direction) : 0;
}

}  // namespace suite
