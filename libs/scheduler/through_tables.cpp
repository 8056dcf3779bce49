#include "scheduler/through_tables.h"

namespace suite {

namespace {

// Rays of the corners and the middle of a capture, at the begin, the middle and the end of its window and of its
// detectors. Receivers look nowhere.
std::vector<Ray> some_rays(const Sensor& sensor, const Capture& capture) {
  std::vector<Ray> rays;
  std::vector<float> weights(sensor.states()[capture.state].size());
  const size_t last = capture.problems() - 1, across = capture.columns - 1;
  for (const size_t problem : {size_t{0}, across, last - across, last, capture.problems() / 2 + capture.columns / 2})
    for (const double u : {0.0, 0.5, 1 - 1e-9}) {
      const std::vector<double> numbers(static_cast<size_t>(sensor.numbers()), u);
      const SensorRay ray = sensor.ray({capture, std::min(problem, last), numbers, weights});
      if (ray.receiver == SensorRay::Receiver::none) rays.push_back(ray.ray);
    }
  return rays;
}

}  // namespace

void look_through_tables(SourceSpecs& written, const Scene& scene, Sensors sensors) {
  if (!written.tabled) return;
  // Once over its place on Earth it stays there.
  SourceSpecs first = written;
  resolve_sources(first, scene);
  written.tabled = first.tabled;
  Box3 all;
  TabledAirSpec::Places places;
  SourcesInTime sources(written, scene);
  for (const auto& sensor : sensors) {
    Box3 box;
    for (const Task& task : sensor->tasks())
      for (const Capture& capture : task.captures) {
        const SourceSpecs& now = sources.at(sources.on_grid(moment_of(capture)));
        check_tabled_air(*now.tabled, now, scene);
        std::optional<Dir> sun;
        if (now.sun()) sun = normalized(now.sun()->disk()->direction);
        for (const Ray& ray : some_rays(*sensor, capture)) {
          check_sight(*now.tabled, ray.origin, ray.direction, sun);
          box.grow(ray.origin);
        }
      }
    if (box.empty()) continue;
    all.grow(box);
    // Between the rays that were asked for others may begin a little outside.
    const double room = 0.01 * length(box.size()) + 0.1;
    places.boxes.push_back({box.low - Vec3{room, room, room}, box.high + Vec3{room, room, room}});
  }
  auto seen = std::make_shared<TabledAirSpec>(*written.tabled);
  if (!all.empty()) {
    places.middle = all.center();
    seen->from = std::move(places);
  }
  written.tabled = std::move(seen);
}

}  // namespace suite
