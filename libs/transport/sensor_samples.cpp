#include "transport/sensor_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "transport/dimensions.h"

namespace suite {

SensorRay ask_ray(const Sensor& sensor, const Capture& capture, size_t problem, const std::array<double, 4>& first,
                  const SampleStream& stream, uint32_t index, std::span<float> weights) {
  const size_t numbers = static_cast<size_t>(sensor.numbers());
  if (numbers <= 4) return sensor.ray({capture, problem, {first.data(), numbers}, weights});
  std::array<double, 8> u;
  const std::array<double, 4> second = stream.draw(index, dimensions::kSensorMore.first);
  std::copy(first.begin(), first.end(), u.begin());
  std::copy(second.begin(), second.end(), u.begin() + 4);
  return sensor.ray({capture, problem, {u.data(), numbers}, weights});
}

bool stand_off(const Tracer& tracer, Ray& ray, std::vector<Hit>& touched, TraceStatistics& statistics) {
  TraceStatistics asking;  // these are no rays of paths
  tracer.touching(ray, touched, asking);
  statistics.cycles += asking.cycles;
  for (const Hit& h : touched) {
    const double to = dot(ray.direction, h.normal) >= 0 ? double{h.step} : -double{h.step};
    ray.origin += h.normal * (to - h.distance);
  }
  return !touched.empty();
}

size_t bin_of(const Capture& capture, const PathRecord& path) {
  if (capture.bin_by == Capture::BinBy::none) return 0;
  if (capture.bin_by == Capture::BinBy::time) {
    const double span = capture.window.end - capture.window.begin;
    const double at = span > 0 ? std::floor((path.time - capture.window.begin) / span * capture.bins) : 0;
    return static_cast<size_t>(std::clamp(at, 0.0, capture.bins - 1.0));
  }
  if (path.end != PathEnd::escaped || path.escape.z < 0) return capture.bins;
  const uint32_t columns = capture.bins / capture.escape_rings;
  const double turn = std::atan2(path.escape.y, path.escape.x) / (2 * kPi);
  const uint32_t ring = std::min(static_cast<uint32_t>(path.escape.z * capture.escape_rings), capture.escape_rings - 1);
  return size_t{ring} * columns + static_cast<uint32_t>((turn + 1) * columns + 0.5) % columns;
}

}  // namespace suite
