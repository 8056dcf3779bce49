// The bins of sensors' states: chosen before anything is rendered, and once more when temperatures are known.
#pragma once
#include <span>
#include <vector>

#include "formats/sim_text/sim_text.h"
#include "scheduler/bins.h"
#include "scheduler/scheduler.h"

namespace suite {

// Chooses the bins of a sensor's states, says what they are good for and keeps what is known of their errors. Error: as
// BinChooser::choose().
void choose_bins_of(Sensor& sensor, BinChooser& chooser, BandBiases& biases);

// States as the text asks for them, before bins are chosen; one list a sensor.
using AskedStates = std::vector<std::vector<SpectralState>>;
AskedStates states_of(const Simulation& sim);

// Bins were chosen before temperatures were found: once more, of what was asked for, where some are hotter than was
// assumed.
void follow_heat(Simulation& sim, const Scene& scene, JobOptions& options, const AskedStates& asked);

}  // namespace suite
