#include "sensor_presets.h"

#include <vector>

#include "base/error.h"
#include "base/registry.h"
#include "day_night_band.h"
#include "instrument_presets.h"
#include "lidar_presets.h"

namespace suite {

std::string list_presets() { return list_instrument_presets() + list_day_night_band() + list_lidar_presets(); }

std::string sensor_preset(const std::string& name) {
  for (const auto& find : {find_instrument_preset, find_day_night_band})
    if (auto text = find(name)) return *text;
  std::vector<std::string> names;
  const std::string list = list_presets();
  for (size_t at = 0; at < list.size(); at = list.find('\n', at) + 1) {
    names.push_back(list.substr(at, list.find(' ', at) - at));
    if (names.back() == name) return lidar_preset(name);  // the only ones left
  }
  throw Error("there is no preset '" + name + "'", name_hint(name, names));
}

}  // namespace suite
