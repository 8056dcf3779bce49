// The glue between sensors and the radiometry core (paper, section III-C): gathers tasks, captures and states, runs them
// in blocks, and routes results and truth back.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiometry/pipeline.h"
#include "sensor/sensor.h"

namespace suite {

struct JobOptions {
  PipelineOptions pipeline;
  std::optional<Periodic> periodic;  // the scene repeats itself horizontally
  uint32_t paths = 0;              // replaces every capture's own convergence by a fixed number of paths; 0 = does not
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

// Paths that a job will run: exactly for fixed counts, at least for adaptive captures (their pilots).
double forecast_paths(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options);

// Runs every capture of every sensor. Deterministic: the same bytes for any number of threads.
JobReport run_job(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, std::span<const std::unique_ptr<Sensor>> sensors,
                  const JobOptions& options);

}  // namespace suite
