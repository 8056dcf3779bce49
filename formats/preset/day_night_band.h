// A sensor like the day/night band of VIIRS, one aggregation zone a text.
#pragma once
#include <optional>
#include <string>

namespace suite {

// Its line.
std::string list_day_night_band();
// YAML of one platform, with the source of its numbers; nothing for another name than viirs_dnb_like, viirs_dnb_like_1
// to _32.
std::optional<std::string> find_day_night_band(const std::string& name);

}  // namespace suite
