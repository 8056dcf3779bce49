// Real air along segments: layers about a round Earth (or flat ones) that absorb, emit and scatter.
//
// Exact for the layers: transmittance; emission with a source that is linear in depth within a layer; sunlight and
// moonlight scattered once. Light that is scattered more often comes from a table of its source over height and
// direction (air/diffuse_field.h), made for a flat and even ground. Not refracted.
// Assumes: the beams to the scattering points are not shadowed by the scene.
// Based on: K.-N. Liou, "An introduction to atmospheric radiation", 2002, equations 3.4.9 and 4.2.9.
#pragma once
#include <memory>
#include <vector>

#include "air/air_spec.h"
#include "light/atmosphere.h"

namespace suite {

// The beams' spectra must live as long. Error: as bake_column.
std::unique_ptr<const Atmosphere> make_stratified_air(const AirSpec& spec, const SpectralState& state,
                                                      std::vector<Beam> beams);

}  // namespace suite
