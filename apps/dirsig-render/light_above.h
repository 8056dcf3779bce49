// Light from above that remote-sensing reflectances are over, found by pre-passes of the job: one plane for each place
// that a sensor names, in the bands and windows of its captures.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "scheduler/prepass.h"
#include "sensor/delivery.h"

namespace suite {

class LightAbove {
 public:
  // Once the sensors' bins are chosen. They must outlive it.
  explicit LightAbove(std::span<const std::unique_ptr<Sensor>> sensors);
  // For JobOptions::prepasses; none where nobody asks.
  std::span<const std::unique_ptr<Sensor>> passes() const { return passes_; }
  // Downward irradiance in a band of a delivery, W/(m2 um), and its standard error, once the passes have run. Error: no
  // light comes down.
  struct Irradiance {
    double mean, error;
  };
  Irradiance of(const Delivery& delivery, const Band& band) const;

 private:
  struct Asked {  // of a sensor
    const Sensor* sensor;
    std::vector<Vec3> places;
    std::vector<size_t> states;
    std::vector<TimeWindow> windows;
    void add(const Capture& capture, Vec3 place);
    void measure(std::vector<std::unique_ptr<Sensor>>& passes);
    const Prepass* pass = nullptr;
  };
  std::vector<Asked> asked_;
  std::vector<std::unique_ptr<Sensor>> passes_;
};

}  // namespace suite
