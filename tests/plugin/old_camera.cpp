// A plug-in that was built with an older header, whose structures are smaller: a map seen straight from above.
#include <suite_sensor.h>

class OldCamera final : public suite_sdk::Sensor {
 public:
  explicit OldCamera(const suite_sdk::Keys& keys) {
    tasks.push_back({sizeof(suite_task), "look", 0, 0});
    add_capture(0, add_state({gaussian("green", 0.55, 0.02)}), 4, 4, 0, 0,
                static_cast<uint32_t>(keys.number("paths", 16)));
  }
  void ray(const suite_ray_request& request, suite_ray& ray) const override {
    ray.origin[0] = static_cast<double>(request.problem % 4);
    ray.origin[1] = static_cast<double>(request.problem / 4);
    ray.origin[2] = 100;
    ray.direction[2] = -1;
  }
};

SUITE_SENSOR_PLUGIN("old_camera", "a map seen straight from above (test)", OldCamera)
