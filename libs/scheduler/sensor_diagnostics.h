// Pictures that will be, or came out, useless: what is wrong with them and what would help. Nothing here stops a run.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "scheduler/moments.h"
#include "transport/pipeline.h"

namespace suite {

struct SensorDiagnostic {
  Dr code;
  std::string sensor, cause, cure;
  bool useless = true;  // else only less exact than it might be
  Diagnostic diagnostic() const { return {code, "sensor '" + sensor + "': " + cause + "; " + cure}; }
};

// What all captures of a sensor came to.
struct SensorOutcome {
  uint64_t paths = 0, nodes = 0;  // of this run
  std::vector<std::string> bands;
  std::vector<bool> bright;  // one a band: some value is above 0
  bool looks_down = false;   // the middle ray of its first capture
  void add(std::span<const Band> bands_of_capture, const CaptureResult& result, const RunStatistics& statistics);
};

// Before rendering, without geometry: every light of a sensor is below the horizon, or sends nothing in one of its
// bands; a capture lasts so long that the sun does not stand still.
std::vector<SensorDiagnostic> diagnose_lights(const SourceSpecs& written, const Scene& scene, Sensors sensors);

// Before rendering: the sensor is under the ground, stands where only its latitude and longitude taken as metres would
// put it, or looks past everything.
std::vector<SensorDiagnostic> diagnose_views(const Tracer& tracer, const SourceSpecs& written, Sensors sensors);

// After rendering: nothing was hit, everything is zero, a band is. complete: the outcome counts all paths.
std::optional<SensorDiagnostic> diagnose_outcome(const Sensor& sensor, const SensorOutcome& outcome, bool complete);

// Raises quality_no_information for problems without light whose rays have all the weight 0, as outside the circle of a
// fisheye lens.
CaptureResult with_blind_flagged(const Sensor& sensor, const Capture& capture, CaptureResult result);

// The ray of a problem's middle at the middle of its capture.
SensorRay middle_ray(const Sensor& sensor, const Capture& capture, size_t problem);

}  // namespace suite
