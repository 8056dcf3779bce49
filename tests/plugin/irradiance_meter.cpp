// A plug-in that collects light over a hemisphere: one problem, facing up, in W/(m2 um).
#include <suite_sensor.h>

class IrradianceMeter final : public suite_sdk::Sensor {
 public:
  explicit IrradianceMeter(const suite_sdk::Keys& keys) : height_(keys.number("height_m", 1)) {
    const uint32_t state = add_state({gaussian("green", 0.55, 0.02)});
    tasks.push_back({sizeof(suite_task), "measure", 0, 0});
    add_capture(0, state, 1, 1, 0, 0, 64);
  }
  void ray(const suite_ray_request&, suite_ray& ray) const override {
    ray.origin[2] = height_;
    ray.direction[2] = 1;
    ray.receiver = SUITE_RECEIVER_PLANE;
    ray.weight = 3.14159265358979323846;
  }

 private:
  double height_;
};

SUITE_SENSOR_PLUGIN("irradiance_meter", "irradiance of a level plane (example plug-in)", IrradianceMeter)
