#include "lidar/pulse_at_work.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

std::optional<PulseAtWork> begin_pulse(const LidarInstrument& instrument, uint64_t number, const Tracer& tracer,
                                       TraceStatistics& statistics) {
  constexpr int kRounds = 8;
  constexpr double kSettled = 1e-13;  // s: 30 um of way
  double round_trip = 0;
  std::optional<PulseAtWork> found;
  for (int round = 0; round < kRounds; ++round) {
    const auto pulse = instrument.pulses->pulse(number, round_trip);
    if (!pulse) return std::nullopt;
    PulseAtWork p;
    p.number = number, p.pulse = *pulse;
    p.laser = pulse->emission * instrument.laser.offset;
    p.receiver = pulse->reception * instrument.receiver.offset;
    const Dir axis = p.laser.vector({0, 0, -1});
    p.time = pulse->time + round_trip / 2;
    const Ray ray{p.laser.translation, axis, p.time};
    Hit hit;
    tracer.nearest({&ray, 1}, {&hit, 1}, false, statistics);
    const RangeGate& gate = instrument.gate;
    p.range = hit.hit() ? hit.distance : kSpeedOfLight * (pulse->start + (gate.stop - gate.start) / 2) / 2;
    const double way = p.range + length(p.laser.translation + axis * p.range - p.receiver.translation);
    found = p;
    const double before = round_trip;
    // Motions are known to the end of the gate.
    round_trip = std::min(way / kSpeedOfLight, pulse->start + gate.stop - gate.start);
    if (round > 0 && std::fabs(round_trip - before) <= kSettled) break;
  }
  return found;
}

void PulsesAtWork::add(PulseAtWork pulse) {
  while (of(pulse.time)) pulse.time = std::nextafter(pulse.time, INFINITY);
  pulses_.push_back(std::move(pulse));
}

const PulseAtWork* PulsesAtWork::of(double time) const {
  // Paths are asked for in the order of their pulses: it is the last one, or the next.
  for (size_t k = 0, i = last_ < pulses_.size() ? last_ : 0; k < pulses_.size(); ++k, ++i) {
    if (i == pulses_.size()) i = 0;
    if (pulses_[i].time == time) return &pulses_[last_ = i];
  }
  return nullptr;
}

}  // namespace suite
