// The sources of a simulation text: lights by their table, atmosphere, earth.
#pragma once
#include "base/params.h"
#include "lidar/instrument.h"
#include "light/environment.h"
#include "light/light_rows.h"
#include "sensor/sensor.h"

namespace suite {

// A number, a file name, or a map {file, column, scale, outside} / {wavelength_um: [...], value: [...], outside}.
Curve read_curve_value(const Params& p);

// Error at the curve when a band of the sensor, which stands at `where`, reaches beyond it.
void check_coverage(const AskedCurve& curve, const Sensor& sensor, const Where& where);
// The same of the filter of a laser radar.
void check_coverage(const AskedCurve& curve, const LidarInstrument& lidar);

// Reads the keys of `root` that describe sources; asked: receives their curves. Located Error for anything wrong.
SourceSpecs read_sources(const Params& root, std::vector<AskedCurve>& asked);

}  // namespace suite
