// Paths without a scheduler: a sensor's problems through one pipeline, to means and errors.
#pragma once
#include <memory>
#include <vector>

#include "tests/support/media_kit.h"
#include "transport/pipeline.h"

namespace suite::test {

struct Seen {                                             // one value a problem, of the only band
  std::vector<double> radiance, standard_error, missing;  // missing: known to be
  RunStatistics statistics;
};

// All of the paths that the sensor's first capture asks for at most. The scene is at rest.
inline Seen see(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, const RaySensor& sensor,
                const PipelineOptions& options = {}) {
  const Capture& capture = sensor.tasks()[0].captures[0];
  const Tracer tracer(scene);
  const Optics optics(*scene, sensor.states()[0]);
  const Environment environment = bake_environment(sources, tracer, false, optics.state());
  const BandProjection projection(optics.state(), sensor.bands(0));
  const TruthPlan truth({}, {tracer, optics.state(), 0, sensor.bands(0), projection, environment});
  const Surface surface(tracer, optics);
  const ChannelPlan channels(sensor.channels());
  const Pipeline pipeline(surface, optics, environment, optics.state(), projection, 0, truth, channels, options);
  const uint32_t paths = capture.convergence.max_paths;
  Accumulators sums({capture.problems(), 1, scrambles_for(paths), truth.slots(), pipeline.may_miss(capture)});
  Seen seen;
  const std::vector<uint32_t> to(capture.problems(), paths);
  for (const Block& block : blocks_of(capture))
    pipeline.run(sensor, capture, 0, block, to, sums, Slots::by_problem, seen.statistics);
  for (size_t i = 0; i < capture.problems(); ++i) {
    double mean = 0, error = 0;
    sums.estimate(i, 0, mean, error);
    seen.radiance.push_back(mean);
    seen.standard_error.push_back(error);
    const std::vector<double> lacking = sums.lacking(i, {&mean, 1});
    seen.missing.push_back(lacking.empty() ? 0 : lacking[0]);
  }
  return seen;
}

}  // namespace suite::test
