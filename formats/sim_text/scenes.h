// The scenes of a simulation. Internal to formats/sim_text.
#pragma once
#include "formats/sim_text/sim_text.h"

namespace suite {

// Keys `scene` or `scenes`.
void read_scenes(const Params& root, Simulation& sim);

}  // namespace suite
