// The sources of a simulation text: sun, moon, sky, lamps, atmosphere, earth.
#pragma once
#include "base/params.h"
#include "light/environment.h"
#include "sensor/sensor.h"

namespace suite {

// A number, a file name, or a map {file, column, scale, outside} / {wavelength_um: [...], value: [...], outside}.
Curve read_curve_value(const Params& p);

// A curve of a source and where it stands, for the check that it covers what the sensors see.
struct AskedCurve {
  Where where;
  std::string what;  // "irradiance"
  Curve curve;
};
// Error at the curve when a band of the sensor, which stands at `where`, reaches beyond it.
void check_coverage(const AskedCurve& curve, const Sensor& sensor, const Where& where);

// Reads the keys of `root` that describe sources; asked: receives their curves. Located Error for anything wrong.
SourceSpecs read_sources(const Params& root, std::vector<AskedCurve>& asked);

}  // namespace suite
