// The diffuse field of a column of air, solved once per state and moment by discrete ordinates.
#pragma once
#include <memory>
#include <span>

#include "air/beam_table.h"
#include "air/column.h"
#include "air/diffuse_source.h"

namespace suite {

// A beam from outside: towards its source; irradiance per bin above the air.
struct AirBeam {
  Dir direction;
  const float* irradiance;
};
// What it came to, for reports and truth; per bin.
struct DiffuseReport {
  std::vector<float> direct, down, up;  // W/(m2 um) through a level area at the ground
  std::vector<float> top_up;            // leaving the air
  std::vector<float> spherical_albedo, ground_albedo;
};

// Null where there is nothing that scatters. The source holds for the column's own extinction: light within the forward
// peak of particles, which discrete ordinates leave on its way, is part of it. tables: one a beam, of the column.
// report may be null.
std::shared_ptr<const DiffuseSource> solve_diffuse_field(const AirSpec& spec, const AirColumn& column,
                                                         const SpectralState& state, std::span<const AirBeam> beams,
                                                         std::span<const BeamTable> tables, DiffuseReport* report);

}  // namespace suite
