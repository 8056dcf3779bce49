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

}  // namespace suite
