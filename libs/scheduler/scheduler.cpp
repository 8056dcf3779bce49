#include "scheduler/scheduler.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "base/progress.h"
#include "scheduler/plan.h"

namespace suite {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

Environment bake_sources(const SourceSpecs& specs, const SpectralState& state) {
  Environment e;
  if (specs.sun) e.sun = std::make_unique<Sun>(*specs.sun, state);
  if (specs.sky) e.sky = std::make_unique<Sky>(*specs.sky, state);
  return e;
}

// Materials that some geometry can show; the others are never baked.
std::vector<bool> used_materials(const Scene& scene, const Tracer& tracer) {
  std::vector<bool> used(scene.materials.size(), false), mesh_seen(scene.meshes.size(), false);
  for (const TracedObject& o : tracer.objects()) {
    if (o.material_override != kNone) used[o.material_override] = true;
    else if (o.mesh != kNone) mesh_seen[o.mesh] = true;
    else if (const uint32_t id = scene.primitives[o.primitive].material; id != kNone) used[id] = true;
  }
  for (size_t m = 0; m < scene.meshes.size(); ++m)
    for (const Part& p : scene.meshes[m].parts)
      if (mesh_seen[m] && p.material != kNone) used[p.material] = true;
  for (const MapBinding& b : scene.map_bindings)
    if (used[b.material])
      for (const uint32_t id : scene.class_maps[b.class_map].materials) used[id] = true;
  return used;
}

// Everything that belongs to one spectral state; kept while captures ask for the same one.
struct StateKit {
  Optics optics;
  Environment environment;
  Surface surface;
  BandProjection projection;
  size_t reference_band = 0;

  StateKit(const Scene& scene, const Tracer& tracer, const SourceSpecs& sources, const SpectralState& state, std::span<const Band> bands)
      : optics(scene, state, used_materials(scene, tracer)), environment(bake_sources(sources, state)), surface(tracer, optics), projection(state, bands) {
    for (size_t b = 0; b < bands.size(); ++b)
      if (std::fabs(bands[b].center_um - state.reference_um) < std::fabs(bands[reference_band].center_um - state.reference_um)) reference_band = b;
  }
};

// Runs samples [from, to) of all problems of a capture, block by block in parallel.
void run_stage(const Pipeline& pipeline, const Sensor& sensor, const Capture& capture, uint64_t id, uint32_t from, std::span<const uint32_t> to,
               Accumulators& sums, RunStatistics& statistics, Progress* progress) {
  const std::vector<Block> blocks = blocks_of(capture);
  std::mutex mutex;
  parallel_for(0, blocks.size(), 1, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b) {
      RunStatistics mine;
      pipeline.run(sensor, capture, id, blocks[b], from, to, sums, mine);
      const std::lock_guard lock(mutex);
      statistics.merge(mine);
      if (progress) progress->add(static_cast<double>(mine.paths));
    }
  });
}

CaptureResult to_result(const Capture& capture, const Accumulators& sums, size_t bands, size_t channels, size_t reference_band, const TruthPlan& truth) {
  CaptureResult r;
  r.columns = capture.columns;
  r.rows = capture.rows;
  r.bands = bands;
  r.channels = channels;
  r.bins = capture.bins;
  r.truth_names = truth.columns();
  const size_t n = capture.problems(), values = r.values_per_problem();
  r.radiance.resize(n * values);
  r.standard_error.resize(n * values);
  r.paths.resize(n);
  r.quality.resize(n);
  r.truth.resize(n * r.truth_names.size());
  for (size_t i = 0; i < n; ++i) {
    for (size_t b = 0; b < values; ++b) sums.estimate(i, b, r.radiance[i * values + b], r.standard_error[i * values + b]);
    r.paths[i] = sums.paths(i);
    const double mean = r.radiance[i * values + reference_band];
    // One sample that carries a tenth of a problem's sum: too few such events were seen for the interval to be trusted.
    if (sums.paths(i) >= 16 && sums.largest(i) > 0.1 * mean * sums.paths(i)) r.quality[i] |= quality_heavy_tail;
    if (sums.failures(i)) r.quality[i] |= quality_failures;
    if (sums.truncated(i) > 0.01f * static_cast<float>(sums.paths(i))) r.quality[i] |= quality_truncated;
    truth.finish(sums.truth(i), sums.paths(i), r.truth.data() + i * r.truth_names.size());
  }
  return r;
}

Convergence goal_of(const Capture& capture, const JobOptions& options) {
  if (!options.paths) return capture.convergence;
  return {options.paths, options.paths, 0, 0};
}

double median_of(std::vector<double>& values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

double forecast_paths(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  double sum = 0;
  for (const auto& s : sensors)
    for (const Task& t : s->tasks())
      for (const Capture& c : t.captures) {
        const Convergence goal = goal_of(c, options);
        sum += static_cast<double>(c.problems()) * (goal.relative_error > 0 ? goal.min_paths : goal.max_paths);
      }
  return sum;
}

JobReport run_job(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources, std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  const Clock::time_point start = Clock::now();
  JobReport report;
  const Tracer tracer(scene, options.periodic);
  report.tracer_builds = 1;
  report.build_seconds = seconds_since(start);
  std::vector<double> relative_errors;
  bool adaptive = false;
  std::unique_ptr<Progress> progress;
  if (options.progress) progress = std::make_unique<Progress>("rendering", forecast_paths(sensors, options), "path");
  uint64_t capture_id = 0;
  for (const auto& sensor : sensors) {
    std::vector<std::unique_ptr<StateKit>> kits(sensor->states().size());
    for (size_t t = 0; t < sensor->tasks().size(); ++t) {
      const Task& task = sensor->tasks()[t];
      for (size_t c = 0; c < task.captures.size(); ++c, ++capture_id) {
        const Capture& capture = task.captures[c];
        std::unique_ptr<StateKit>& kit = kits[capture.state];
        if (!kit) {
          kit = std::make_unique<StateKit>(*scene, tracer, sources, sensor->states()[capture.state], sensor->bands(capture.state));
          ++report.optics_bakes;
        }
        const TruthPlan truth(sensor->truth(), {tracer, kit->optics.state(), capture.state, sensor->bands(capture.state), kit->projection, kit->environment});
        const Pipeline pipeline(kit->surface, kit->optics, kit->environment, kit->optics.state(), kit->projection, kit->reference_band, truth, options.pipeline);
        const size_t bands = kit->projection.bands();
        const Convergence goal = goal_of(capture, options);
        const size_t channels = sensor->channels().size();
        Accumulators sums(capture.problems(), bands * channels * capture.bins, Accumulators::scrambles_for(goal.max_paths), truth.slots());
        sensor->begin(capture);
        std::vector<uint32_t> plan(capture.problems(), goal.relative_error > 0 ? goal.min_paths : goal.max_paths);
        run_stage(pipeline, *sensor, capture, capture_id, 0, plan, sums, report.statistics, progress.get());
        if (goal.relative_error > 0) {
          adaptive = true;
          plan = plan_paths(capture, sums, kit->reference_band);
          run_stage(pipeline, *sensor, capture, capture_id, goal.min_paths, plan, sums, report.statistics, progress.get());
        }
        CaptureResult result = to_result(capture, sums, bands, channels, kit->reference_band, truth);
        result.task = t;
        result.capture = c;
        for (size_t i = 0; i < capture.problems(); ++i)
          if (const double mean = result.radiance[i * result.values_per_problem() + kit->reference_band]; mean > 0)
            relative_errors.push_back(result.standard_error[i * result.values_per_problem() + kit->reference_band] / mean);
        report.problems += capture.problems();
        ++report.captures;
        sensor->accept(std::move(result));
      }
    }
  }
  if (progress) progress->finish();
  report.seconds = seconds_since(start);
  report.median_relative_error = median_of(relative_errors);
  report.share_in_embree = report.statistics.cycles ? static_cast<double>(report.statistics.trace.cycles) / static_cast<double>(report.statistics.cycles) : 0;
  report.stopped_by = adaptive ? "two stages: a pilot of all problems, then a number of paths planned from the neighbours' variance" : "a fixed number of paths for every problem";
  return report;
}

}  // namespace suite
