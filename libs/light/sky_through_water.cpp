#include "light/sky_through_water.h"

namespace suite {

SkyThroughWater::SkyThroughWater(const std::vector<SkySpec>& knots) {
  for (const SkySpec& knot : knots) knots_.emplace_back(knot);
}

DirectionSample SkyThroughWater::draw(size_t knot, Vec2 u) const {
  if (!knots_[knot].tabulated()) return {{0, 0, 1}, 0};
  return knots_[knot].draw(u);
}

void SkyThroughWater::densities(Dir direction, std::span<double> density) const {
  for (size_t k = 0; k < density.size(); ++k) density[k] = knots_[k].tabulated() ? knots_[k].density(direction) : 0;
}

}  // namespace suite
