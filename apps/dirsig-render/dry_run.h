// --dry-run: what would be run, after all that a run would refuse has been.
#pragma once
#include <memory>

#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

// Prints the forecast. Error: as a run, before it or in it.
void dry_run(const std::shared_ptr<const Scene>& scene, const Simulation& simulation, const JobOptions& options,
             const RenderOptions& render);

}  // namespace suite
