// What the diffuse field of a column of air needs before it is solved bin by bin.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "air/beam_table.h"
#include "air/column.h"
#include "air/diffuse_source.h"
#include "air/discrete_ordinates.h"
#include "air/round_light.h"

namespace suite {

// A beam from outside: towards its source; irradiance per bin above the air.
struct AirBeam {
  Dir direction;
  const float* irradiance;
};

// Directions of the table, denser towards the horizon, where ways are long.
DiffuseSource::Axes diffuse_axes(const AirColumn& column, std::span<const AirBeam> beams);

// Depth of a beam at the levels over a place, [level][bin], infinite in the shadow of the Earth. cosine: of its zenith
// angle there.
std::vector<double> level_depths(const AirColumn& column, double cosine, const BeamTable& table);
// The same of one bin as plane layers take it, counted from the top down to the column's ground.
struct LayerBeam {
  std::vector<double> depth, secants, tops;  // of the levels; of the layers
  // Valid until the next call.
  DiffuseBeam through(const AirColumn& column, const std::vector<double>& of_levels, size_t bin, double cosine,
                      float irradiance);
};

// Depths of beams at the levels over a place, infinite in the shadow of the Earth; each [level][bin].
struct BeamDepths {
  // At the scene's origin; and where the only beam stands as low as the suns of the source.
  std::vector<std::vector<double>> of_beams, of_suns;
};
// Gives the source the suns that it needs, too: round a low one over a round Earth. tables: one a beam, of the column.
BeamDepths beam_depths(const AirColumn& column, std::span<const AirBeam> beams, std::span<const BeamTable> tables,
                       DiffuseSource& source);

// Phase functions between a beam and the directions of the source; [direction][kind][bin], 1/sr.
std::vector<float> beam_phases(const AirColumn& column, const AirBeam& beam, const DiffuseSource& source);

// What a round Earth needs beside its column, between the cosines of the source; null: it is flat.
struct RoundWays {
  std::unique_ptr<const AirWays> round, flat;
  RoundWays(const AirColumn& column, const std::vector<double>& cosines);
};

}  // namespace suite
