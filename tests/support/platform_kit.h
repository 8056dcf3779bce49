// Sensors from text, run over small scenes without files; and what a ray of theirs sees of a level ground.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "formats/motion/motion.h"
#include "sensor/sensors.h"
#include "support/radiometry_kit.h"

namespace suite::test {

struct Shot {
  ImageRows rows;
  CaptureResult result;
  std::vector<Product> products;
  std::vector<TextFile> texts;
};

struct PlatformKit {
  std::vector<Shot> shots;
  std::optional<SceneFrame> frame;
  std::map<std::string, GreyImage> images;

  std::unique_ptr<Sensor> make(const std::string& yaml) {
    const Params params = Params::parse_text(yaml, "sensor.yaml");
    MotionContext motion;
    motion.frame = frame;
    motion.clock = Clock({2026, 6, 21, 10, 30, 0});
    SensorContext context;
    context.curve = [](const Params& p) {
      if (p.kind() == Params::Kind::map)
        return Curve(p.at("wavelength_um").as_numbers(), p.at("value").as_numbers(), Outside::zero);
      return Curve::constant(p.as_number());
    };
    context.deliver = [this](const Delivery& d) { shots.push_back({d.rows, d.result, d.products, d.texts}); };
    context.track = [motion](const Params& p) { return track_from(p, motion); };
    context.position = [motion](const Params& p) { return position_from(p, motion); };
    context.jitter = [](const Params& p, uint64_t seed) { return jitter_from(p, seed); };
    context.time = [](const Params& p) { return p.as_number(); };
    context.image = [this](const std::string& path) { return images.at(path.substr(path.rfind('/') + 1)); };
    context.frame = [this] { return frame; };
    auto sensor = make_sensor(params, context);
    params.reject_unread();
    return sensor;
  }

  // Renders the sensor of a text; its shots are added to `shots`.
  JobReport render(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, const std::string& yaml) {
    std::vector<std::unique_ptr<Sensor>> sensors;
    sensors.push_back(make(yaml));
    JobOptions job;
    job.progress = false;
    return run_job(scene, sources, sensors, job);
  }
};

// The ray of a problem for given uniform numbers (missing ones are 0.5).
inline SensorRay ray_of(const Sensor& sensor, const Capture& capture, size_t problem, std::vector<double> u = {}) {
  u.resize(8, 0.5);
  std::vector<float> weights(sensor.states()[capture.state].size());
  return sensor.ray({capture, problem, {u.data(), static_cast<size_t>(sensor.numbers())}, weights});
}
// Where a ray meets the plane z = height.
inline Vec3 on_ground(const Ray& ray, double height = 0) {
  return ray.origin + ray.direction * ((height - ray.origin.z) / ray.direction.z);
}

}  // namespace suite::test
