// Air of a simulation text that other programs have computed: `atmosphere` with `tables`.
#pragma once
#include <memory>

#include "base/params.h"
#include "light/tabled_air.h"
#include "sensor/sensor.h"

namespace suite {

// Located Error, in the text or in a file that it names, for anything wrong.
std::shared_ptr<const TabledAirSpec> read_tabled_air(const Params& p);
// Error when a band of the sensor, which stands at `where`, reaches beyond the tables.
void check_coverage(const TabledAirSpec& air, const Sensor& sensor, const Where& where);

}  // namespace suite
