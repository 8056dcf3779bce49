// How much a run may spend, on top of what the sensors ask for themselves.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "sensor/sensor.h"

namespace suite {

struct Budget {
  std::optional<uint32_t> min_paths, max_paths;  // replace those of every capture; equal = a fixed count
  std::optional<double> relative_error;          // target; 0 = none, the maximum is used
  std::optional<double> absolute_floor;          // W/(m2 sr um): below it the error is judged absolutely
  bool all_bands = false;                        // the target holds for every band, not only at the reference
  double seconds = 0;  // of the whole run, sets a maximum of paths after the first pilot; 0 = none
  uint32_t more = 0;   // added to every capture's maximum: what a continued run adds
  bool operator==(const Budget&) const = default;
};

inline constexpr uint32_t kDefaultPilot = 32, kDefaultMost = 4096;

// What a capture is to reach under a budget. A target for a capture of fixed count starts from kDefaultPilot paths and
// may use up to kDefaultMost unless the budget says otherwise.
Convergence goal_of(const Convergence& asked, const Budget& budget);
inline Convergence goal_of(const Capture& capture, const Budget& budget) {
  return goal_of(capture.convergence, budget);
}

// What the problems of a capture are to reach: one goal for all, or each its own.
struct Goals {
  Convergence all;               // least minimum, largest maximum and least target of those that are met
  std::vector<Convergence> own;  // one a problem; empty = `all` holds for each
  // The goal of one problem; its maximum is never more than all.max_paths, which a time budget may lower.
  Convergence of(size_t problem) const;
};
// Error: a problem that may take no path, or more at least than at most.
Goals goals_of(const Sensor& sensor, const Capture& capture, const Budget& budget);

}  // namespace suite
