// The table of sensor kinds: one row a kind, made from what the user wrote.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/params.h"
#include "sensor/sensor.h"

namespace suite {

// What a sensor needs from the outside when it is made.
struct SensorContext {
  std::function<Curve(const Params&)> curve;   // reads a curve from a number, a file name or {file: ..., ...}
  std::function<void(const Sensor&, const CaptureResult&)> deliver;  // receives every finished capture
};

struct SensorRow {
  std::string name;        // "frame_camera"
  std::string summary;     // one line for --list-sensors
  std::unique_ptr<Sensor> (*make)(const Params& params, const SensorContext& context);
};

std::span<const SensorRow> sensor_kinds();
// Reads `kind` and makes the sensor; located Error for anything wrong.
std::unique_ptr<Sensor> make_sensor(const Params& params, const SensorContext& context);

// Parts that several kinds share.
std::vector<Band> read_bands(const Params& list, const SensorContext& context);
Convergence read_convergence(const Params& params);   // key `paths`: N, or {min, max, relative_error, absolute_floor}

}  // namespace suite
