// Even bins of spectral states under real air (air_choice.h chooses others): intervals so narrow that gases are alike
// within them, split into g-points where gases absorb (libs/air).
#pragma once
#include <span>

#include "air/air_spec.h"
#include "spectral/state.h"

namespace suite {

struct AirBins {
  SpectralState intervals;  // evenly divided, before they are split
  SpectralState state;
};
// Intervals at most 10 nm or, beyond 2.58 um, 15 cm-1 wide, at most half as wide as the narrowest band, and no wider
// than the state's choice asks for. Even bins (choice.error = 0) stay as they are, wider than half a band, where
// one g-point does for them (GasReduction) or where every band responds in all of them alike, so that their g-points
// are those of the bands; others are divided evenly. What is seen in them does not choose
// them. The first g-point of an interval is the one that gases absorb least, so reference and knots are transparent.
// Error, located: bands beyond what the gases are known for, by name.
AirBins bins_in_air(const AirSpec& air, const SpectralState& state, std::span<const Band> bands);

// Error, located: the same.
void check_gases_known(const AirSpec& air, const SpectralState& state, std::span<const Band> bands);

}  // namespace suite
