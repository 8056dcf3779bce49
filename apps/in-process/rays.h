// Rays of the caller's as a sensor: one problem each.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "sensor/sensor.h"

namespace suite {

struct RayRequests {
  size_t count = 0;
  const double *origin = nullptr, *direction = nullptr;  // count x 3
  std::vector<double> time;                              // s, of each
};

struct RayAnswers {
  double *radiance, *standard_error;  // count x bands
  uint8_t* quality;                   // count, or null
};

// All rays of one time are a capture; `like` says what a capture may take, all but its place, time and size.
class RaySensor final : public Sensor {
 public:
  RaySensor(std::string name, SpectralState state, std::vector<Band> bands, const Capture& like,
            const RayRequests& rays, const RayAnswers& answers);
  std::string name() const override { return name_; }
  std::span<const SpectralState> states() const override { return {&state_, 1}; }
  std::span<const Band> bands(size_t) const override { return bands_; }
  std::span<const Task> tasks() const override { return tasks_; }
  std::span<const std::string> truth() const override { return {}; }
  SensorRay ray(const RayRequest& request) const override;
  void accept(CaptureResult&& result) override;

 private:
  std::string name_;
  SpectralState state_;
  std::vector<Band> bands_;
  std::vector<Task> tasks_;
  std::vector<std::vector<size_t>> members_;  // of each capture: numbers of rays
  const RayRequests& rays_;
  const RayAnswers& answers_;
};

}  // namespace suite
