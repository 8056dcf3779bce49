// A pulse while it is traced: where laser and receiver are, and which rays are of it.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "lidar/instrument.h"
#include "trace/tracer.h"

namespace suite {

struct PulseAtWork {
  uint64_t number = 0;   // of the train
  ResponsePulse pulse;   // received when light from `range` is back
  double time = 0;       // s, of its rays, scene time; no other pulse at work has the same
  Pose laser, receiver;  // from their frames to ENU
  double range = 0;  // m, along the beam's axis to what it meets first; the middle of the gate where that is nothing
  Dir at_laser(Dir d) const { return rotate(laser.rotation.conjugate(), d); }
  Dir at_receiver(Dir d) const { return rotate(receiver.rotation.conjugate(), d); }
};

// A pulse with its pose of reception: a fixed point on the time for which light is under way to the target on the
// beam's axis and back. Nothing where no beam leaves. Rays stand at the time at which light turns back there.
std::optional<PulseAtWork> begin_pulse(const LidarInstrument& instrument, uint64_t number, const Tracer& tracer,
                                       TraceStatistics& statistics);

// Those that run together, by the time of their rays.
class PulsesAtWork {
 public:
  void clear() { pulses_.clear(); }
  // Moves its time by the least amount where another pulse has it.
  void add(PulseAtWork pulse);
  size_t size() const { return pulses_.size(); }
  const PulseAtWork& operator[](size_t i) const { return pulses_[i]; }
  const PulseAtWork* of(double time) const;  // null: none

 private:
  std::vector<PulseAtWork> pulses_;  // ascending in time only where the train is
  mutable size_t last_ = 0;          // found
};

}  // namespace suite
