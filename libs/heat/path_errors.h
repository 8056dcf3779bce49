// How far the paths may have led temperatures astray, and how far they differ within an element.
#pragma once
#include "heat/compact_rows.h"
#include "heat/heat_balance.h"

namespace suite {

struct SolvedSurfaces {
  const ExchangePaths& exchange;
  const Sunlight& sun;  // what mirrors send on, and what is one number a face
  const WeatherLoads& weather;
  const std::vector<SurfaceGroup>& groups;
  const SurfaceLoads& loads;
  const SurfaceHistory& history;
  double ground_albedo;
  const SurfaceNeighbours& neighbours;
};

// What is known before temperatures are: of sunlight, what each block's paths bring, and how points within an element
// differ. Rows of the parts of the span, W/m2.
struct LoadErrors {
  CompactRows of_block;  // by face and block, halves' differences over 2
  CompactRows spread;    // by face and contrast (Sunlight::beam_spread)
};
// shares: of the moments by interval of rest (interval_shares()).
// How far an uneven sky as so many paths of a block find it may be off, W/m2, [face][part].
std::vector<float> uneven_sky(const Sunlight& sun, const WeatherLoads& weather,
                              const std::vector<std::vector<float>>& shares, uint32_t paths);
// uneven: of that. Uses up what the sunlight has by block and of its spread.
LoadErrors load_errors(Sunlight& sun, const std::vector<float>& uneven, const WeatherLoads& weather,
                       const std::vector<std::vector<float>>& shares, double ground_albedo);

struct LinearErrors {
  std::vector<float> paths;  // K, standard error of the mean of all blocks, [face][part of the span]
  std::vector<float> size;   // K, root of the mean square of what places of the element differ from its mean
};
// What loads differ by, as means over the parts, goes through the conduction of its element with the faces' exchange
// linearised about the solution, as a periodic state. Of the paths: what the halves of each block differ by
// (path_numbers.h); what neighbours make of it is left out: they emit as solved. Of the size: direct sun on the points
// of the element (Sunlight::beam_spread); what sky and neighbours send is taken as even over it, and conduction along
// the surface, which evens out, is left out there; errors of the paths go along it. At least kHeatParts moments.
LinearErrors linear_errors(const SolvedSurfaces& solved, LoadErrors&& loads);

}  // namespace suite
