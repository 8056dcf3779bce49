// The glue between sensors and the radiometry core (paper, section III-C): gathers tasks, captures and states, runs them
// in blocks, and routes results and truth back.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radiometry/pipeline.h"
#include "sensor/sensor.h"

namespace suite {

struct JobOptions {
  PipelineOptions pipeline;
  bool progress = true;
};

// Sources before they are baked for a state.
struct SourceSpecs {
  std::optional<SunSpec> sun;
  std::optional<SkySpec> sky;
};

struct JobReport {
  RunStatistics statistics;
  size_t captures = 0, problems = 0;
  size_t tracer_builds = 0, optics_bakes = 0;
  double seconds = 0, build_seconds = 0;
  double share_in_embree = 0;      // of the CPU time of the pipeline
  double median_relative_error = 0;  // standard error over radiance, reference band, all problems with radiance > 0
  std::string stopped_by;          // one sentence
};

// Runs every capture of every sensor. Deterministic: the same bytes for any number of threads.
JobReport run_job(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, std::span<const std::unique_ptr<Sensor>> sensors,
                  const JobOptions& options);

}  // namespace suite
