// What sensors read through: motions, times and pictures, in the frame of the simulation's scene. Internal to
// formats/sim_text.
#pragma once
#include "formats/sim_text/sim_text.h"

namespace suite {

// Keys `epoch` and `dut1_s`.
void read_epoch(const Params& root, Simulation& sim);
// Everything but the reader of curves.
SensorContext sensor_context(const Simulation& sim, const SimulationCallbacks& callbacks);

}  // namespace suite
