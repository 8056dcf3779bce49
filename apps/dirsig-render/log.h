// The log of a run, render.json: what was run, capture by capture.
#pragma once
#include <string>

#include "options.h"
#include "scheduler/scheduler.h"

namespace suite {

void write_log(const std::string& path, const JobReport& report, const JobOptions& options);

// Largest memory that this process has had so far.
double peak_bytes();

}  // namespace suite
