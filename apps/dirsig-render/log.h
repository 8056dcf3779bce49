// The log of a run, render.json: what was run, capture by capture.
#pragma once
#include <span>
#include <string>

#include "options.h"
#include "scheduler/scheduler.h"

namespace suite {

// air_limits: the sentences of tell_air.
void write_log(const std::string& path, const JobReport& report, const JobOptions& options,
               std::span<const std::string> air_limits);

// Largest memory that this process has had so far.
double peak_bytes();

}  // namespace suite
