// What sensors are told when a run begins.
#pragma once
#include <string>

#include "formats/sim_text/sim_text.h"

namespace suite {

// Before run_job, when bins are chosen. folder: of the results, and of files that sensors write themselves; empty: they
// write none (a study).
void start_sensors(const Simulation& simulation, const JobOptions& options, const std::string& folder);

}  // namespace suite
