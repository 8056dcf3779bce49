// A capture on its way: what it is primed with, its plan and its result.
#pragma once
#include <algorithm>
#include <memory>
#include <optional>

#include "base/interrupt.h"
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
                   primed->kit.bands->reference, primed->truth, work.goals, work.bias);
    const std::span<const std::string> channels = work.sensor.channels();
    const auto channel = [&](const char* name) {
      return static_cast<size_t>(std::find(channels.begin(), channels.end(), name) - channels.begin());
    };
    if (const size_t q = channel("stokes_q"), u = channel("stokes_u"); std::max(q, u) < channels.size())
      result->tell_stokes(q, u);
    planner.emplace(work, *result, saving);
  }
  // Bytes that its sums and its result take, at most: a function of what is asked for alone.
  double bytes() const {
    const auto n = static_cast<double>(work.capture.problems()), values = static_cast<double>(work.values);
    const Accumulators::Shape row{1, work.values, scrambles_for(work.goals.all.max_paths), work.truth_slots, false};
    // Covariances of Stokes vectors and what follows from them.
    const double stokes = primed->pipeline.of_stokes() ? 104 * static_cast<double>(primed->projection().bands()) : 0;
    return n * (static_cast<double>(row.bytes()) + 24 * values + 200 + stokes);
  }
  const Item& item;
  const std::shared_ptr<const Primed> primed;
  CaptureWork work;
  std::optional<ResultBuilder> result;
  std::optional<CapturePlanner> planner;  // nothing where another process of the job leads
  CaptureLog log;
};

using Batch = std::vector<std::unique_ptr<InFlight>>;

// What the captures have goes into the state, whoever wants the program to end.
inline void save_all(const Batch& batch) {
  const FinishFirst first;
  for (const auto& c : batch)
    if (c->planner) c->planner->save();
}

// Rounds as they were told; refers to what was told.
inline std::vector<Round> rounds_of(std::span<const SentRound> sent, const Batch& batch) {
  std::vector<Round> rounds;
  for (const SentRound& t : sent) {
    const CaptureWork& work = batch.at(t.capture)->work;
    rounds.push_back(round_of(t, work.pipeline, work.sensor, work.capture));
  }
  return rounds;
}

// The seconds of a batch, shared out by what its captures took.
inline void share_seconds(const Batch& batch, double seconds) {
  double cycles = 0;
  const auto of = [](const InFlight& c) { return c.planner ? static_cast<double>(c.planner->statistics().cycles) : 0; };
  for (const auto& c : batch) cycles += of(*c);
  for (const auto& c : batch) {
    const double share = cycles > 0 ? of(*c) / cycles : 1 / static_cast<double>(batch.size());
    c->log.seconds = share * seconds;
  }
}

}  // namespace suite
