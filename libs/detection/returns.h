// What a detector tells of a pulse: returns with their times, and times from sampled voltages (leading edge with a
// threshold, constant fraction).
#pragma once
#include <optional>
#include <vector>

#include "detection/waveform.h"

namespace suite {

struct LidarReturn {
  double time = 0;       // s after the emission of the pulse that the receiver counts from
  double deviation = 0;  // s, standard deviation of time as the detector knows it; 0 = it does not
  double amplitude = 0;  // of the pulse, in the detector's unit above its baseline
  double width = 0;      // s, standard deviation of the pulse; 0 = not measured
  double baseline = 0;   // decomposed: what lies below all pulses
  bool signal = true;    // truth: not background, dark current, afterpulse or cross-talk
  uint32_t number = 1, of = 1;
};
// Numbers returns in the order of their times.
void number_returns(std::vector<LidarReturn>& returns);

// A leading edge crosses `level` upwards and may do so again once the signal was below level - hysteresis; `dead` s
// after a crossing it hears nothing. Times are interpolated between middles of samples.
//
// Walk: a Gaussian of deviation s and amplitude A crosses at -s sqrt(2 ln(A / level)) before its peak.
struct Threshold {
  double level = 0;  // > 0
  double hysteresis = 0;
  double dead = 0;  // s
  size_t most = 65535;
};
std::vector<LidarReturn> leading_edges(std::span<const double> signal, const SampleGrid& grid, const Threshold& t);

// Constant fraction: the signal later by `delay` against `fraction` of itself; their difference crosses zero upwards,
// for a Gaussian of deviation s at delay / 2 - s^2 ln(1 / fraction) / delay after its peak, whatever its amplitude.
// Told where the signal was above the threshold since the crossing before.
struct ConstantFraction {
  Threshold arm;
  double fraction = 0.5;  // 0..1, both excluded
  double delay = 0;       // s, > 0
};
std::vector<LidarReturn> constant_fractions(std::span<const double> signal, const SampleGrid& grid,
                                            const ConstantFraction& c);

}  // namespace suite
