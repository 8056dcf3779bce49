// What sensors of the tests with one spectral state and one task have in common.
#pragma once
#include <utility>
#include <vector>

#include "sensor/sensor.h"

namespace suite::test {

class OneStateSensor : public Sensor {
 public:
  OneStateSensor(std::string name, std::vector<Band> bands, SpectralState state, std::vector<Capture> captures)
      : name_(std::move(name)), bands_(std::move(bands)), state_(std::move(state)) {
    tasks_.push_back({name_, {}, std::move(captures)});
  }
  std::string name() const override { return name_; }
  std::span<const SpectralState> states() const override { return {&state_, 1}; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  std::span<const Task> tasks() const override { return tasks_; }

 protected:
  // Where a sample lies in the grid of its capture: column and row, in problems.
  static std::pair<double, double> place_of(const RayRequest& r) {
    return {static_cast<double>(r.problem % r.capture.columns) + r.u[0],
            static_cast<double>(r.problem / r.capture.columns) + r.u[1]};
  }

 private:
  std::string name_;
  std::vector<Band> bands_;
  SpectralState state_;
  std::vector<Task> tasks_;
};

}  // namespace suite::test
