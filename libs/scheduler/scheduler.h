// The glue between sensors and the radiometry core (paper, section III-C): gathers tasks, captures and states, orders
// them so that states change seldom, runs them in blocks, and routes results and truth back.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "estimate/budget.h"
#include "scheduler/kits.h"
#include "scheduler/sensor_diagnostics.h"
#include "scheduler/share.h"
#include "scheduler/shortfall.h"
#include "scheduler/state_store.h"
#include "sensor/quality.h"
#include "spectral/band_bias.h"
#include "transport/pipeline.h"

namespace suite {

// What a store held when a job began.
struct StoredWork {
  size_t captures = 0, finished = 0;  // of the job; of them those that are computed to their plan
  double paths = 0;                   // that need not be run again
};

class Executor;  // executor.h

struct JobOptions {
  // Sensors that run before the others, all of them to what they ask for themselves, whatever the budget; their
  // captures are numbered after those of the others, whose results they do not change but through `loads`. While they
  // run, surfaces that wait for loads do not glow. prepass.h has one.
  std::span<const std::unique_ptr<Sensor>> prepasses = {};
  // Asked once, when the pre-passes have accepted their results and before materials are baked for the sensors: what
  // heats surfaces whose temperature models ask for it. Empty = nothing does.
  std::function<LoadsAt()> loads = {};
  // What is known already of surfaces whose temperatures ask for loads.
  Heating heating = {};
  PipelineOptions pipeline;
  std::optional<Periodic> periodic;  // the scene repeats itself horizontally
  Budget budget;
  size_t kit_bytes = kDefaultKitBytes;  // of optics and lights that are kept for captures to come (kits.h)
  TileLimit tiles = {};                 // of what the scene's tiles take (trace/tracer.h)
  StateStore* store = nullptr;          // keeps what is needed to continue; null = nothing is kept
  Executor* executor = nullptr;         // who runs the rounds; null = the threads of this process
  // Only these blocks of the sensors' captures are run, and pre-passes whole; needs a store. Only a share that runs
  // nothing has results: those of the captures that the store has whole. Nothing = a run by itself.
  std::optional<Share> share = {};
  BandBiases biases = {};  // of the sensors' bins (bins.h): where a band misses what is wanted, part of its error
  bool progress = true;
  // Asked between blocks of problems: true ends the job in good order, with all that is finished in the store. Empty =
  // never.
  std::function<bool()> stop;
  std::function<void(const StoredWork&)> begun;   // called once, before the first capture of a job that has a store
  std::function<void(uint32_t)> time_worth = {};  // is told the maximum of paths that a time budget is turned into
  // Called once for each diagnostic: before the paths are run for what a state's light will lack and for pictures that
  // will be useless, after them for those that are. Empty = nobody listens.
  std::function<void(const Diagnostic&)> diagnose = {};
};

// What one capture took; a line of the log.
struct CaptureLog {
  std::string sensor, task, capture, state;
  std::string kernel;  // Pipeline::kernel()
  size_t id = 0;       // number of the capture in the job, counted over sensors, tasks and captures
  TimeWindow window;
  size_t problems = 0;
  RunStatistics statistics;
  double seconds = 0;
  double median_relative_error = 0;  // at the reference band
  bool new_tracer = false, new_optics = false;
};

// The problem furthest from its target.
struct WorstProblem {
  std::string sensor, capture;
  uint32_t column = 0, row = 0;
  double relative_error = 0;
};

// Pre-passes count as sensors, after the others.
struct JobReport {
  RunStatistics statistics;
  size_t captures = 0, problems = 0;  // that were finished and delivered
  size_t captures_asked = 0;
  size_t captures_waiting = 0;  // of a share: they are not whole without what other shares run;
  size_t pilots_waiting = 0;    // of these: not even planned
  double paths_waiting = 0;     // those of their plans, where the share runs nothing itself
  double paths_kept = 0;        // that a store held when the job began; the statistics count them, without their cycles
  bool stopped = false;  // JobOptions::stop ended the job; statistics count what the unfinished capture took, too
  size_t tracer_builds = 0, optics_bakes = 0, state_changes = 0;
  TileUse tiles;           // under a limit
  size_t light_bakes = 0;  // environments made or brought to another moment
  double seconds = 0, build_seconds = 0;
  double deliver_seconds = 0;          // sensors taking their results
  double share_in_embree = 0;          // of the CPU time of the pipeline
  double median_relative_error = 0;    // standard error over radiance, reference band, all problems with radiance > 0
  double share_at_target = 0;          // of the problems of captures with a target
  double share_flagged = 0;            // of all problems: any flag
  std::vector<SensorQuality> quality;  // one a sensor, in their order
  WorstProblem worst;                  // at the judged bands; relative_error 0 = none
  uint32_t time_cap = 0;               // maximum of paths that a time budget was turned into; 0 = none
  std::string stopped_by;              // one sentence: the rule that ended the run, share at target, worst pixel
  // What each sensor's results lack, in the order of the sensors.
  struct SensorShortfall {
    std::string sensor;
    Shortfall shortfall;
  };
  std::vector<SensorShortfall> shortfalls;
  std::vector<CaptureLog> log;  // in the order in which captures ran
};

// Paths that a job will run: exactly for fixed counts, at least for adaptive captures (their pilots).
double forecast_paths(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options);
// The order in which a job runs its captures (their ids), and the state changes that it takes. moves: something in the
// scene moves, so that each time window is a state of its own.
struct JobOrder {
  std::vector<size_t> captures;
  size_t state_changes = 0;
};
JobOrder order_of(std::span<const std::unique_ptr<Sensor>> sensors, bool moves = false, bool dated = false);
// Bytes that the accumulators and the result of the largest capture take.
double forecast_bytes(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options);

// Runs every capture of every pre-pass, then of every sensor. sources: as written; what follows from dates is resolved
// for each capture, in the middle of its window (moments.h). Deterministic: the same bytes for any number of threads,
// for any order, and for a run that was interrupted and continued from its store.
JobReport run_job(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
                  std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options);

}  // namespace suite
