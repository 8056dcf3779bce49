// Far points (stars) on a sensor's focal plane: put there one by one, dimmed by the air of the line of sight, hidden by
// what stands in it.
//
// Assumes: what stands in the way hides them wholly, but for smooth surfaces that pass or mirror them (point_sight.h):
// a flat one at rest has an image of each; polarimeters see neither. Media do not dim them; the Earth, where the
// simulation has none, is a sphere of 6371 km under the scene.
#pragma once
#include "base/diagnostics.h"
#include "scheduler/primed.h"
#include "sensor/sensor.h"

namespace suite {

// Adds the points of the lights to a result's radiance, and to the channels that take light from outside; hands a
// sensor the table of those it sees. Nothing where the sensor, or no light, knows points.
void add_points(const Primed& primed, Sensor& sensor, const Capture& capture, CaptureResult& result);

// Stars and planets above the horizon, in smooth surfaces where they have no images (transport/flat_mirrors.h) for a
// sensor that puts them on its focal plane: nothing where there are no such points, or no such surfaces.
std::optional<Diagnostic> diagnose_points(const Tracer& tracer, const Environment& environment, const Optics& optics,
                                          const Sensor& sensor);

}  // namespace suite
