// Flags of pixels: those that detectors set when they are read, and what is said of all.
#pragma once
#include <map>
#include <string>

#include "scheduler/scheduler.h"
#include "sensor/delivery.h"
#include "stokes_checks.h"

namespace suite {

// Takes what is delivered: counts what detectors add to the flags, since the job has judged its results before they are
// read, and what polarisation is not known of.
class DetectorFlags {
 public:
  void take(const Delivery& delivery);
  // Their share of the report; and a warning of sensors whose light is known without its polarisation in part.
  void add_to(JobReport& report) const;

 private:
  struct Count {
    uint64_t clipped = 0, alone = 0;  // pixels; alone: that carry no other flag
  };
  std::map<std::string, Count> of_;  // by sensor
  DepolarisedLight depolarised_;
};

// How many pixels of each sensor are flagged, and what the flags that occur mean. Warns of a sensor whose counts are
// clipped in more than a hundredth of its pixels.
void report_quality(std::span<const SensorQuality> sensors);

}  // namespace suite
