// Runs one capture: pilot, plan, the rest; in parallel over blocks of problems, saving what is finished as it goes.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "estimate/budget.h"
#include "estimate/plan.h"
#include "radiometry/pipeline.h"
#include "scheduler/result.h"
#include "scheduler/state_store.h"

namespace suite {

// Thrown by run_capture when its work asked it to stop.
struct Stopped {};

// Paths of each problem that a capture is computed to. needs: of its pilot, empty without one.
std::vector<uint32_t> plan_of(const Capture& capture, const Goals& goals, std::span<const double> needs);

struct CaptureWork {
  const Pipeline& pipeline;
  const Sensor& sensor;
  const Capture& capture;
  uint64_t id = 0;  // of the capture in the job: part of the key of its sample points
  Goals goals;
  std::vector<JudgedBand> judged;  // bands whose error decides
  StateStore* store = nullptr;     // null = nothing is kept
  Progress* progress = nullptr;
  // Called once the pilot is finished, with the needs (all 0 without a target) and the seconds that the pilot took for
  // `paths` new paths; may lower goals.all.max_paths (a time budget). Empty = nothing does.
  std::function<void(CaptureWork&, std::span<const double> needs, double paths, double seconds)> after_pilot;
  std::function<bool()> stop;  // asked before each block; empty = never
};

// Runs all problems and hands each to the builder. Without pilot and store the sums of a block live only as long as the
// block runs; otherwise those of the whole capture are kept. A capture whose pilot decides without neighbours is
// sampled anew after it, from other sample points: its pilot is thrown away. values, truth_slots: doubles of a problem
// in its accumulators. Throws Stopped when work.stop asked for it, with all finished rows of blocks in the store.
void run_capture(CaptureWork& work, size_t values, size_t truth_slots, ResultBuilder& result,
                 RunStatistics& statistics);

}  // namespace suite
