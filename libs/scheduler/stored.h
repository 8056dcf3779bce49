// What a store has to hold of a capture, and how far it has it.
#pragma once
#include <map>
#include <utility>

#include "estimate/budget.h"
#include "scheduler/scheduler.h"

namespace suite {

// Doubles of truth that a problem gathers; the same for all captures of a sensor's state.
class TruthSlots {
 public:
  explicit TruthSlots(const Tracer& tracer) : tracer_(tracer) {}
  size_t of(const Sensor& sensor, size_t state);

 private:
  const Tracer& tracer_;
  std::map<std::pair<const Sensor*, size_t>, size_t> known_;
};

CaptureShape shape_of(const Sensor& sensor, const Capture& capture, const Goals& goals, TruthSlots& slots);

// Adds what a store holds of a capture to what it holds of a job. capped: a pilot decides about the capture even
// without a target.
void add_stored(StateStore& store, size_t id, const Capture& capture, const Goals& goals, bool capped,
                StoredWork& work);

}  // namespace suite
