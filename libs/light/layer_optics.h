// The quick atmosphere's layers (AtmosphereSpec) as a spectral state sees them.
#pragma once
#include <vector>

#include "light/atmosphere.h"

namespace suite {

// Everything is [layer][bin], layers from the ground up, 1/m but for `source`.
struct LayerOptics {
  size_t layers = 0, bins = 0;
  std::vector<float> extinction, rayleigh, aerosol;  // all of it; what molecules and what particles scatter of it
  std::vector<float> source;                         // blackbody times the absorbed share, W/(m2 sr um)
};

// The spec must be one that make_layered_atmosphere takes.
LayerOptics bake_layers(const AtmosphereSpec& spec, const SpectralState& state);

}  // namespace suite
