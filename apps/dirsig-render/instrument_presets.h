// Imaging instruments by published numbers, as texts to paste into `sensors:`.
#pragma once
#include <optional>
#include <string>

namespace suite {

// A line for each.
std::string list_instrument_presets();
// YAML of one platform, with the source of its numbers; nothing: no such preset.
std::optional<std::string> find_instrument_preset(const std::string& name);

}  // namespace suite
