// What a run would refuse once it has begun, asked for by --dry-run.
#pragma once
#include <memory>

#include "formats/sim_text/sim_text.h"

namespace suite {

// The optics of every state of every sensor. Error, at the sensor's line, with the band in which something is not known
// or cannot be made.
void check_optics(const std::shared_ptr<const Scene>& scene, const Simulation& sim);

}  // namespace suite
