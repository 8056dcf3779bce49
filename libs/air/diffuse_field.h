// The diffuse field of a column of air, solved once per state and moment by discrete ordinates in flat layers, with
// what a round Earth changes (round_light.h) where the column's is.
#pragma once
#include <memory>
#include <span>

#include "air/diffuse_setup.h"

namespace suite {

// What it came to, for reports and truth; per bin.
struct DiffuseReport {
  std::vector<float> direct, down, up;  // W/(m2 um) through a level area at the ground
  std::vector<float> top_up;            // leaving the air, over as much of the ground's area
  std::vector<float> spherical_albedo, ground_albedo;
};

// Null where there is nothing that scatters. The source holds for the column's own extinction: light within the forward
// peak of particles, which discrete ordinates leave on its way, is part of it. tables: one a beam, of the column.
// report may be null.
std::shared_ptr<const DiffuseSource> solve_diffuse_field(const AirSpec& spec, const AirColumn& column,
                                                         const SpectralState& state, std::span<const AirBeam> beams,
                                                         std::span<const BeamTable> tables, DiffuseReport* report);

}  // namespace suite
