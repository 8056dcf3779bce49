// A capture on its way: what it is primed with, its plan and its result.
#pragma once
#include <memory>
#include <optional>

#include "scheduler/items.h"
#include "scheduler/planner.h"
#include "scheduler/primed.h"
#include "scheduler/result.h"

namespace suite {

struct InFlight {
  InFlight(const Item& i, std::shared_ptr<const Primed> p, const Sensor& sensor, const Capture& capture, Goals goals,
           std::vector<JudgedBand> judged)
      : item(i),
        primed(std::move(p)),
        work{primed->pipeline,
             sensor,
             capture,
             i.id,
             std::move(goals),
             std::move(judged),
             primed->projection().bands() * sensor.channels().size() * capture.bins,
             primed->truth.slots()} {}
  // To be called when all of the work is known.
  void plan(Saving& saving) {
    result.emplace(work.capture, primed->projection().bands(), work.sensor.channels().size(),
                   primed->kit.bands->reference, primed->truth, work.goals);
    planner.emplace(work, *result, saving);
  }
  const Item& item;
  const std::shared_ptr<const Primed> primed;
  CaptureWork work;
  std::optional<ResultBuilder> result;
  std::optional<CapturePlanner> planner;
  CaptureLog log;
};

using Batch = std::vector<std::unique_ptr<InFlight>>;

// The seconds of a batch, shared out by what its captures took.
inline void share_seconds(const Batch& batch, double seconds) {
  double cycles = 0;
  for (const auto& c : batch) cycles += static_cast<double>(c->planner->statistics().cycles);
  for (const auto& c : batch) {
    const double share = cycles > 0 ? static_cast<double>(c->planner->statistics().cycles) / cycles
                                    : 1 / static_cast<double>(batch.size());
    c->log.seconds = share * seconds;
  }
}

}  // namespace suite
