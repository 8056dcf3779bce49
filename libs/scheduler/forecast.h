// What is known of a job's length before it begins, beside forecast_paths() (scheduler.h).
#pragma once
#include "scheduler/scheduler.h"

namespace suite {

// Whether forecast_paths() is the number of paths that will be run: no capture goes on until an error is reached.
bool paths_are_fixed(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options);

}  // namespace suite
