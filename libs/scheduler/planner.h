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
  std::vector<BandBias> bias = {};  // of its bands by their bins; empty: not known
  std::vector<uint8_t> mine = {};   // [block] 1 where it is run here; empty = everywhere. With it, a store is needed.
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
  // The round to run next, decided from what the last one brought; nothing when there is nothing more to do here.
  std::optional<Round> next();
  // The round that next() gave was run, whole or in part.
  void ran(const Round& round);
  // Saves what is finished.
  void save();
  // When there is nothing more to do: whether the result has been given all problems; whether others have to run parts
  // of the pilot; the paths of the plan that others have to run.
  bool whole() const { return whole_; }
  bool waits_for_pilot() const { return waits_for_pilot_; }
  double waits_for() const { return waits_for_; }
  // What all that stands in the sums took, with cycles of what was run here.
  const RunStatistics& statistics() const { return statistics_; }

 private:
  class Saver;
  enum class Stage : uint8_t { begin, pilot, rest, done };
  bool mine(size_t block) const { return work_.mine.empty() || work_.mine[block]; }
  std::vector<Block> open_blocks(const Accumulators* sums, std::span<const uint32_t> to, bool mine) const;
  bool decided() const;
  Round round(std::vector<uint32_t> to, uint64_t stream, Accumulators* sums, bool save);
  Round first();
  bool decide();
  Round rest();
  void finish();

  CaptureWork& work_;
  ResultBuilder& result_;
  Saving& saving_;
  const bool target_, alone_, piloted_;
  Accumulators::Shape shape_;
  std::unique_ptr<Accumulators> sums_, thrown_;  // null: none are kept
  std::unique_ptr<BlockCounts> counts_;          // likewise; of what is stored
  std::unique_ptr<Saver> saver_;
  Stage stage_ = Stage::begin;
  std::vector<double> needs_;
  std::vector<uint32_t> to_;
  RunStatistics statistics_;
  double pilot_paths_ = 0, waits_for_ = 0;
  bool whole_ = false, waits_for_pilot_ = false;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace suite
