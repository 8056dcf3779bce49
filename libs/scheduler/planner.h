// Deciding, apart from running: which blocks of a capture are run next, and to which counts. Pilot, plan, the rest.
//
// A decision follows from the counts and the pilot's needs alone, so that every process that takes part can make it;
// the needs are one number a problem.
#pragma once
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "estimate/budget.h"
#include "estimate/plan.h"
#include "scheduler/executor.h"
#include "scheduler/result.h"
#include "scheduler/state_store.h"

namespace suite {

// Paths of each problem that a capture is computed to. needs: of its pilot, empty without one.
std::vector<uint32_t> plan_of(const Capture& capture, const Goals& goals, std::span<const double> needs);

// With a time budget, fixed counts too begin with a pilot.
void shorten_pilots(Goals& goals);

// What the captures of a job share that are saved while they run: one at a time, and not more often than every few
// seconds, because a save waits for the disk.
struct Saving {
  StateStore* store = nullptr;  // null = nothing is kept
  std::mutex mutex;
  std::chrono::steady_clock::time_point last = std::chrono::steady_clock::now();
};

struct CaptureWork {
  const Pipeline& pipeline;
  const Sensor& sensor;
  const Capture& capture;
  uint64_t id = 0;  // of the capture in the job: part of the key of its sample points
  Goals goals;
  std::vector<JudgedBand> judged;  // bands whose error decides
  size_t values = 0;               // doubles of a problem's sums: [channel][bin][band]
  size_t truth_slots = 0;
  // Called once the pilot is finished, with the needs (all 0 without a target) and the seconds that the pilot took for
  // `paths` new paths; may lower goals.all.max_paths (a time budget). Empty = nothing does.
  std::function<void(CaptureWork&, std::span<const double> needs, double paths, double seconds)> after_pilot = {};
};

// Plans one capture. Without pilot and store the sums of a block live only as long as the block runs; otherwise those
// of the whole capture are kept. A capture whose pilot decides without neighbours is sampled anew after it, from other
// sample points: its pilot is thrown away.
class CapturePlanner {
 public:
  // Keeps references. result: is given all problems.
  CapturePlanner(CaptureWork& work, ResultBuilder& result, Saving& saving);
  ~CapturePlanner();
  // The round to run next, decided from what the last one brought; nothing when the result has all problems.
  std::optional<Round> next();
  // The round that next() gave was run, whole or in part.
  void ran(const Round& round);
  // Saves what is finished.
  void save();
  const RunStatistics& statistics() const { return statistics_; }

 private:
  class Saver;
  enum class Stage : uint8_t { begin, pilot, rest, done };
  Round round(std::vector<uint32_t> to, uint64_t stream, Accumulators* sums, bool save);
  Round first();
  void decide();
  Round rest();

  CaptureWork& work_;
  ResultBuilder& result_;
  Saving& saving_;
  const bool target_, alone_, piloted_;
  Accumulators::Shape shape_;
  std::unique_ptr<Accumulators> sums_, thrown_;  // null: none are kept
  std::unique_ptr<Saver> saver_;
  Stage stage_ = Stage::begin;
  std::vector<double> needs_;
  std::vector<uint32_t> to_;
  RunStatistics statistics_;
  double pilot_paths_ = 0;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace suite
