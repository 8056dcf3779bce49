// How far the paths may have led temperatures astray.
#pragma once
#include "heat/heat_balance.h"

namespace suite {

struct SolvedSurfaces {
  const ExchangePaths& exchange;
  const Sunlight& sun;
  const WeatherLoads& weather;
  const std::vector<SurfaceGroup>& groups;
  const SurfaceLoads& loads;
  const SurfaceHistory& history;
  double ground_albedo;
};

// Standard error of the mean of all blocks, K, [face][part of the span]. Each block's own loads, as means over the
// parts, differ from those of all; the difference goes through the conduction of its element with the faces' exchange
// linearised about the solution, as a periodic state. At least kHeatParts moments. What neighbours make of it is left
// out: they emit as solved.
std::vector<float> path_errors(const SolvedSurfaces& solved);

}  // namespace suite
