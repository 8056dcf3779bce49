// Instruments by public numbers, each a text of one sensor with the sources of its numbers: to paste into `sensors:`,
// or to be named there by `preset:`. See FORMAT.md.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/params.h"

namespace suite {

// A line for each: name and summary. Laser radars stand behind the others.
std::string list_presets();
std::string list_lidar_presets();
// YAML, a list of one sensor. Error: no such preset, with a name that is near.
std::string preset_text(const std::string& name);

// A text made of a simulation's: every sensor that names a preset is the preset with what the sensor says of its own.
struct ExpandedText {
  std::string yaml;
  std::vector<Where> origins;  // of each line, in the simulation's text or as "preset NAME"
};
// Nothing where no sensor names one. Error: no such preset, a sensor of another kind than its preset.
std::optional<ExpandedText> expand_presets(const Params& simulation);

// A simulation's text and its settings (base/params.h), presets in their places. Settings of keys `preset` come first,
// so that the others may be of what the preset has.
Params parse_simulation(const std::string& path, std::span<const std::string> settings);

}  // namespace suite
