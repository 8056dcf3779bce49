// The log of a run, render.json: what was run, capture by capture, and each laser radar.
#pragma once
#include <string>

#include "base/json.h"
#include "options.h"
#include "scheduler/scheduler.h"

namespace suite {

void write_log(const std::string& path, const JobReport& report, const JobOptions& options, Json lidars);

// Largest memory that this process has had so far.
double peak_bytes();

}  // namespace suite
