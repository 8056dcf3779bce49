// One line per sensor file: the row it adds to the table in sensors.cpp.
#pragma once
#include "sensor/sensors.h"

namespace suite {

SensorRow frame_camera_row();
SensorRow platform_row();

}  // namespace suite
