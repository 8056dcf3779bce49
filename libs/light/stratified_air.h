// Real air along segments: layers about a round Earth (or flat ones) that absorb, emit and scatter.
//
// Exact for the layers: transmittance; emission with a source that is linear in depth within a layer; sunlight and
// moonlight scattered once. Light that is scattered more often comes from a table of its source over height and
// direction (air/diffuse_field.h), made for an even ground.
//
// Quicker where that is as good: what a beam scatters on a thin part of a way (depth below 0.25), or on the first part
// of any under a sun near the scene's middle (local_air.h), the beam within 78 degrees of the zenith and straight,
// comes from series and tables, within 2e-4 of itself (beam_light.h); transmittance of ways that leave the air at more
// than 3 degrees over the level from the beams' tables, within 5e-6 (tests/physics/light/thin_air_test.cpp). The sky
// that surfaces ask for, or that continuations meet, is one value of its table for each direction, drawn with the
// weight that it would have between its neighbours.
//
// Segments are straight. With AirSpec::refraction the beams are bent on their way from outside to the places that they
// light, in the air and, as transmittance to infinity, on surfaces (air/beam_table.h): what is left of them is that of
// the bent way, which may come from below the plane. Their directions stay the true ones, those without air: angles of
// scattering, the side from which surfaces are lit, shadows, and where the disks are seen; less than 0.6 degrees off at
// the ground's horizon. Beams that the air scatters are also spread by it, which takes 11 % of the zenith's light at
// 0.55 um under a sun at 92 degrees; surfaces see them narrow, so that a level area gets what it gets in truth, where
// light falls steeper but from a flattened disk, and walls 0.9 % more at 80 degrees from the zenith, 3.2 % at 85.
// Assumes: an even ground under it; what the scene makes of that is found by paths (air_vertices.h).
// Based on: K.-N. Liou, "An introduction to atmospheric radiation", 2002, equations 3.4.9 and 4.2.9.
#pragma once
#include <memory>
#include <vector>

#include "air/air_spec.h"
#include "air/column.h"
#include "light/atmosphere.h"

namespace suite {

// The beams' spectra must live as long. column: bake_column(spec, state), which does not depend on them.
std::unique_ptr<const Atmosphere> make_stratified_air(const AirSpec& spec, std::shared_ptr<const AirColumn> column,
                                                      const SpectralState& state, std::vector<Beam> beams);
// Error: as bake_column.
std::unique_ptr<const Atmosphere> make_stratified_air(const AirSpec& spec, const SpectralState& state,
                                                      std::vector<Beam> beams);

}  // namespace suite
