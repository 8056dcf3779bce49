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
    // The first pixel may have a number of paths of its own.
    first_paths_ = static_cast<uint32_t>(keys.number("first_paths", 0));
    own_convergence = first_paths_ > 0;
    // What this wavelength (um) is weighed with 1, others in proportion; 0: all alike.
    unit_um_ = keys.number("unit_um", 0);
  }
  void ray(const suite_ray_request& request, suite_ray& ray) const override {
    const double column = static_cast<double>(request.problem % size_) + request.u[0],
                 row = static_cast<double>(request.problem / size_) + request.u[1];
    ray.origin[0] = (column - 0.5 * size_) * gsd_;
    ray.origin[1] = (0.5 * size_ - row) * gsd_;
    ray.origin[2] = height_;
    ray.direction[2] = -1;
    ray.weighted = unit_um_ > 0;
    for (uint32_t i = 0; ray.weighted && i < request.bins; ++i)
      request.weights[i] = static_cast<float>(request.bin_um[i] / unit_um_);
  }
  void convergence(uint32_t, uint64_t problem, suite_convergence& c) const override {
    if (problem == 0) c.min_paths = c.max_paths = first_paths_;
  }
  void accept(const suite_result& result) override {
    double sum = 0;
    for (uint32_t i = 0; i < result.columns * result.rows * result.bands; ++i) sum += result.radiance[i];
    std::printf("grid_camera: mean radiance %.6f, %u paths in the first pixel, %u in the last\n",
                sum / (result.columns * result.rows * result.bands), result.paths[0],
                result.paths[result.columns * result.rows - 1]);
  }

 private:
  unsigned size_ = 0;
  uint32_t first_paths_ = 0;
  double gsd_ = 0, height_ = 0, unit_um_ = 0;
};

SUITE_SENSOR_PLUGIN("grid_camera", "a map seen straight from above (example plug-in)", GridCamera)
