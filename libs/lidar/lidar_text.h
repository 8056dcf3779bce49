// A laser radar as a user writes it: `kind: lidar` of a simulation's sensors. apps/dirsig-render/LIDAR.md has the
// grammar.
#pragma once
#include "base/params.h"
#include "lidar/instrument.h"
#include "sensor/sensors.h"

namespace suite {

// Key `gate`'s `bin_ns`, `paths` and `orders` of texts that do not say.
inline constexpr double kDefaultRangeBin = 1e-10;  // s
// Whether an item of `sensors` is one.
bool is_lidar(const Params& sensor);
// Reads all but what detection reads (keys detectors, pulses_in_air, output, las, csv, and laser's `pulse`), for which
// `LidarInstrument::detection` holds the map. Error, located, for anything wrong; also for motion that does not cover
// the pulses and the light on its way.
LidarInstrument read_lidar(const Params& params, const SensorContext& context);

}  // namespace suite
