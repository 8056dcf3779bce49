#include "sensor/sensor.h"

namespace suite {

std::span<const std::string> default_truth() {
  static const std::vector<std::string> names{"material", "instance", "range", "location", "paths", "hits"};
  return names;
}

std::span<const std::string> Sensor::truth() const { return default_truth(); }

std::span<const Channel> Sensor::channels() const {
  static constexpr Channel only[] = {Channel::radiance};
  return only;
}

}  // namespace suite
