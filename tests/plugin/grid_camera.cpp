// The smallest useful plug-in: a map seen straight from above, of as many columns and rows as the user says.
#include <suite_sensor.h>

#include <cstdio>
#include <stdexcept>

class GridCamera final : public suite_sdk::Sensor {
 public:
  explicit GridCamera(const suite_sdk::Keys& keys) {
    size_ = static_cast<unsigned>(keys.number("pixels", 16));
    gsd_ = keys.number("gsd_m", 1);
    height_ = keys.number("height_m", 1000);
    if (size_ < 1 || size_ > 4096) throw std::runtime_error("pixels must be 1 to 4096");
    const uint32_t state = add_state({gaussian("green", 0.55, 0.02), gaussian("red", 0.65, 0.02)});
    tasks.push_back({sizeof(suite_task), "look", 0, 0});
    add_capture(0, state, size_, size_, 0, 0, static_cast<uint32_t>(keys.number("paths", 16)));
    truth = {"material", "range"};
  }
  void ray(const suite_ray_request& request, suite_ray& ray) const override {
    const double column = static_cast<double>(request.problem % size_) + request.u[0],
                 row = static_cast<double>(request.problem / size_) + request.u[1];
    ray.origin[0] = (column - 0.5 * size_) * gsd_;
    ray.origin[1] = (0.5 * size_ - row) * gsd_;
    ray.origin[2] = height_;
    ray.direction[2] = -1;
  }
  void accept(const suite_result& result) override {
    double sum = 0;
    for (uint32_t i = 0; i < result.columns * result.rows * result.bands; ++i) sum += result.radiance[i];
    std::printf("grid_camera: mean radiance %.6f\n", sum / (result.columns * result.rows * result.bands));
  }

 private:
  unsigned size_ = 0;
  double gsd_ = 0, height_ = 0;
};

SUITE_SENSOR_PLUGIN("grid_camera", "a map seen straight from above (example plug-in)", GridCamera)
