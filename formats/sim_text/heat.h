// The blocks `weather` and `heat` of a simulation text.
#pragma once
#include "base/params.h"
#include "formats/sim_text/sim_text.h"
#include "sensor/sensors.h"

namespace suite {

// Nothing without `heat`. Error, located: weather without heat and the other way round, no date for either.
std::optional<HeatRequest> read_heat_request(const Params& root, const Simulation& sim, const SensorContext& context);

}  // namespace suite
