// Sensors that ask for a standard error of the degree of linear polarisation.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "base/params.h"
#include "sensor/sensor.h"

namespace suite {

// Of what a sensor sees in every band; absolute. It holds beside the targets of radiance (Convergence, band_targets).
// Where it is the only one, Convergence::relative_error is the same number, as the unit of the plan, and band_targets
// are all 0.
struct DegreeTarget {
  double error = 0;  // 0 = none
  Where where = {};  // for messages
};
// Key `paths: {dolp_error: N}`, 1e-6 to 1. Sets convergence and band_targets, which have been read, where radiance has
// no target of its own.
DegreeTarget read_degree_target(const Params& params, std::span<const Band> bands, Convergence& convergence,
                                std::vector<double>& band_targets);
// Error, located: a sensor that does not see Q and U; bins, in which an exposure is told in parts.
void check_degree_target(const DegreeTarget& target, std::span<const std::string> channels, uint32_t bins);

class HasDegreeTarget {
 public:
  virtual ~HasDegreeTarget() = default;
  virtual double degree_target(const Capture& capture) const = 0;  // 0 = none
};
// Of any sensor.
double degree_target_of(const Sensor& sensor, const Capture& capture);

}  // namespace suite
