// Turns a complete path into the radiance that arrives at the sensor (paper, section IV-A, step 5, and equation 5),
// for all wavelengths of the state, from the last node back to the first:
//   L_n = c_n Le_n + S_n + w_n / p_n L_{n+1}
// and across a segment that crosses media
//   L = gathered + through L.
// With S the explicit sources and c the spectral factor of the prefix. Other processors (polarisation, arrival times)
// walk the same record.
#pragma once
#include <span>

#include "radiometry/pipeline.h"
#include "radiometry/wave.h"

namespace suite {

// radiance: per bin, W/(m2 sr um). Overwrites the wave's scratch spectra.
void process_path(Wave& wave, size_t p, const Environment& environment, std::span<float> radiance);

// The part of it that was scattered or emitted once (Channel::single): the first node without its continuation, or
// everything where the path met no second node. After process_path, whose result is `radiance`.
void process_single(Wave& wave, size_t p, const Environment& environment, std::span<const float> radiance,
                    std::span<float> single);

// The light that the path is known to have missed (Path::missed), as radiance at the sensor. single: only what would
// have been scattered once. Overwrites the wave's scratch spectra but the second.
void process_missed(Wave& wave, size_t p, const Environment& environment, bool single, std::span<float> radiance);

}  // namespace suite
