// Sensors that see polarisation: what they cannot be asked for together with, and what their light was worth.
#pragma once
#include <map>
#include <string>

#include "formats/sim_text/sim_text.h"
#include "sensor/delivery.h"

namespace suite {

// Error: a sensor of polarisation under air whose light is known without it, or whose Q, U and V would be written as
// counts or temperatures. Before rendering.
void check_stokes(const Simulation& sim, const Sensor& sensor);

// How much of the light of sensors that see polarisation passed what no Mueller matrix is known of.
class DepolarisedLight {
 public:
  void take(const Delivery& delivery);
  // Warns of a sensor where it is more than a hundredth, over all of its pixels and bands.
  void report() const;

 private:
  struct Sum {
    double depolarised = 0, all = 0;
  };
  std::map<std::string, Sum> of_;  // by sensor
};

}  // namespace suite
