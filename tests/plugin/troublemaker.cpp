// Does what a plug-in must not do, as the key `trouble` says: rays of NaN, of no direction, of infinite weight;
// exceptions.
#include <suite_sensor.h>

#include <cmath>
#include <stdexcept>

class Troublemaker final : public suite_sdk::Sensor {
 public:
  explicit Troublemaker(const suite_sdk::Keys& keys) : trouble_(keys.text("trouble", "none")) {
    if (trouble_ == "make") throw std::runtime_error("this one does not want to be made");
    const uint32_t state = add_state({gaussian("green", 0.55, 0.02)});
    if (trouble_ == "task")
      add_capture(7, state, 4, 4, 0, 0, 16);
    else
      add_capture(0, state, 4, 4, 0, 0, 16);
    tasks.push_back({sizeof(suite_task), "look", 0, 0});
    own_convergence = trouble_ == "goal" || trouble_ == "no_goal";
  }
  void convergence(uint32_t, uint64_t, suite_convergence& c) const override {
    if (trouble_ == "no_goal") throw std::runtime_error("no goal today");
    c.max_paths = 0;
  }
  void ray(const suite_ray_request& request, suite_ray& ray) const override {
    ray.origin[2] = 100;
    ray.direction[2] = -1;
    if (request.problem % 2) return;  // every other pixel behaves
    if (trouble_ == "nan") ray.origin[0] = NAN;
    if (trouble_ == "direction") ray.direction[2] = 0;
    if (trouble_ == "weight") ray.weight = INFINITY;
    if (trouble_ == "throw") throw std::runtime_error("no ray today");
  }
  void accept(const suite_result&) override {
    if (trouble_ == "accept") throw std::runtime_error("no result today");
  }

 private:
  std::string trouble_;
};

SUITE_SENSOR_PLUGIN("troublemaker", "breaks the rules (test)", Troublemaker)
