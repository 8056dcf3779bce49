// Cameras and scanners by public numbers, as texts to paste into `sensors:`.
#pragma once
#include <string>

namespace suite {

// A line for each, laser radars (lidar_presets.h) behind the others.
std::string list_presets();
// YAML of one sensor, with the source of its numbers; of a laser radar, too. Error: no such preset.
std::string sensor_preset(const std::string& name);

}  // namespace suite
