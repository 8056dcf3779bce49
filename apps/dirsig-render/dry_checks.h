// What a run would refuse once it has begun, asked for by --dry-run.
#pragma once
#include <memory>

#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

// Makes, for every state of every sensor, what its captures are primed with (materials, lights, truth), and the poses
// of all that moves in their times; nothing is traced. Error: what a run would refuse, at the sensor's line, with the
// band in which something is not known.
void check_captures(const std::shared_ptr<const Scene>& scene, const Simulation& simulation, const JobOptions& options);

// A fault of a run without a place, as check_captures() places it; where that finds nothing, of the text as a whole.
Error located_in_captures(const Error& fault, const std::shared_ptr<const Scene>& scene, const Simulation& simulation,
                          const JobOptions& options);

}  // namespace suite
