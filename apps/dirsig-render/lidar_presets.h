// Instruments by public numbers, as texts to paste into `sensors:`.
#pragma once
#include <string>

namespace suite {

// A line for each.
std::string list_lidar_presets();
// YAML of one sensor, with the source of its numbers. Error: no such preset.
std::string lidar_preset(const std::string& name);

}  // namespace suite
