// When a receiver listens after each pulse: always, within fixed arrivals, or around what came back before.
#pragma once
#include <deque>

#include "base/params.h"

namespace suite {

struct GateSpec {
  enum class Kind { all, fixed, follow } kind = Kind::all;
  double start = 0, stop = 0;    // s after the emission; of `follow` where it searches until something came back
  double ahead = 0, behind = 0;  // s before and after the median of what came back
  size_t memory = 1;             // pulses whose returns count, 1..10000
};

// Key `gate`: all, {start_m | start_ns, stop_m | stop_ns}, the same with follow: {ahead_m, behind_m, pulses}. Metres
// are c t / 2 in vacuum. Located Errors.
GateSpec read_gate(const Params& params);

class Gate {
 public:
  explicit Gate(const GateSpec& spec) : spec_(spec) {}
  struct Window {
    double start, stop;  // s after the emission
  };
  // Of the next pulse. whole: what the response has.
  Window window(Window whole) const;
  // s after the emission: the first returns of all pixels of the pulse that was read. None: nothing came back, and the
  // next pulse is searched for from `start` to `stop` again.
  void learn(std::span<const double> first_returns);

 private:
  GateSpec spec_;
  std::deque<double> seen_;  // medians of pulses
};

}  // namespace suite
