#include "sensor/sensor.h"

#include "base/error.h"

namespace suite {

std::span<const std::string> default_truth() {
  static const std::vector<std::string> names{"material", "instance", "range", "location", "paths", "hits"};
  return names;
}

std::span<const std::string> Sensor::truth() const { return default_truth(); }

void Sensor::take_state(size_t, SpectralState) { throw Bug("a sensor whose states stay as they are was given one"); }

std::span<const std::string> default_channels() {
  static const std::vector<std::string> names{"radiance"};
  return names;
}

std::span<const std::string> Sensor::channels() const { return default_channels(); }

}  // namespace suite
