// The spectra of sources outside the scene and of lamps, and of the air on their way.
#pragma once
#include "scheduler/seen_spectra.h"

namespace suite {

// Adds what shines. sources: resolved, and kept by reference. Error: as the sources themselves when they are baked.
void add_lights(const SourceSpecs& sources, std::vector<SeenSpectra>& to);

// Blackbody radiance, W/(m2 sr um), the mean of each bin.
std::vector<float> blackbody_means(std::span<const Bin> bins, double kelvin);

}  // namespace suite
