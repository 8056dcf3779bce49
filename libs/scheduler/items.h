// The captures of a job as what they need, and the order in which they run.
#pragma once
#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "motion/time_span.h"
#include "scheduler/order.h"
#include "sensor/sensor.h"

namespace suite {

// Numbers of spectral states, equal for states that bake alike (SpectralState::key).
class StateNumbers {
 public:
  size_t of(const SpectralState& state) { return known_.try_emplace(state.key(), known_.size()).first->second; }

 private:
  std::map<std::vector<double>, size_t> known_;
};

// A capture of the job and what it needs.
struct Item {
  size_t sensor, task, capture, id;
  StatePair state;
  double moment;  // s, at which its sources are taken (moments.h)
};

inline TimeSpan hull(const TimeSpan& span, const TimeWindow& window) {
  return {std::min(span.begin, window.begin), std::max(span.end, window.end)};
}

// All captures, numbered over sensors, tasks and captures. moves: something in the scene does, so that windows differ.
std::vector<Item> items_of(std::span<const std::unique_ptr<Sensor>> sensors, bool moves);

// Fewest changes of state; `changes` is set to their number. Captures of equal states run in the order of their moments
// when dates move the sources (dated), so that those of one moment share their lights.
std::vector<Item> in_cheapest_order(const std::vector<Item>& items, bool dated, size_t& changes);

}  // namespace suite
