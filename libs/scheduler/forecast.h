// What is known of a job's length before it begins, beside forecast_paths() (scheduler.h).
#pragma once
#include "base/progress.h"
#include "scheduler/scheduler.h"

namespace suite {

// Whether forecast_paths() is the number of paths that will be run: no capture goes on until an error is reached.
bool paths_are_fixed(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options);
// The line of a job's progress. spent: s, of its budget.
std::unique_ptr<Progress> begin_progress(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options,
                                         double spent);

}  // namespace suite
