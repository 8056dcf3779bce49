// One line per sensor file: the row it adds to the table in sensors.cpp.
#pragma once
#include "sensor/sensors.h"

namespace suite {

SensorRow frame_camera_row();
SensorRow platform_row();
SensorRow orthographic_row();
SensorRow fisheye_row();
SensorRow point_row();
SensorRow goniometer_row();
SensorRow rami_row();

template <class Kind>
std::unique_ptr<Sensor> make_kind(const Params& params, const SensorContext& context) {
  return std::make_unique<Kind>(params, context);
}

}  // namespace suite
