// Detectors that count: single primary electrons trigger them, and then they are blind. One simulation of events in
// continuous time for Geiger-mode arrays (framed and asynchronous) and for counting through several pixels.
//
// Assumes: primaries are a Poisson process whose rate is even within a sample; every pixel is armed when the gate
// opens; afterpulses are of clicks, and what is released while a pixel is blind is lost. Based on: G. F. Knoll,
// "Radiation Detection and Measurement", chapter 4 (dead times); P. Gatt, S. Johnson, T. Nichols, "Geiger-mode
// avalanche photodiode ladar receiver performance characteristics and detection statistics", Applied Optics 48, 2009.
#pragma once
#include <limits>

#include "detection/variates.h"
#include "detection/waveform.h"

namespace suite {

struct CountingSpec {
  double dead = std::numeric_limits<double>::infinity();  // s; infinite = once in a gate (framed)
  bool paralysable = false;                               // what comes in the dead time lengthens it
  double afterpulse = 0;                                  // probability that a click has one, 0..1, 1 excluded
  double afterpulse_time = 0;                             // s, mean delay
  double crosstalk = 0;            // probability that a click triggers one neighbour (of four), 0..0.25
  double jitter = 0;               // s, FWHM of the Gaussian part
  double tail = 0, tail_time = 0;  // share of clicks with an exponential delay besides, and its mean, s
  double hold_off = 0;             // s after the gate opens in which nothing is counted
  double resolution = 0;           // s, of the time-to-digital converter; 0 = exact
};

struct Click {
  enum class Cause : uint8_t { signal, background, afterpulse, crosstalk };
  double time = 0;  // s after the emission, as told: with jitter, and the middle of a converter's step
  uint32_t pixel = 0;
  Cause cause = Cause::signal;
};

// All clicks of an array in one gate, by pixel and time. pixels: row by row, all on one grid. Error: more than 1e6
// events (a bright target and no dead time).
std::vector<Click> count_primaries(const CountingSpec& spec, std::span<const Expected> pixels, uint32_t columns,
                                   Pcg32& random);

// What the first count of a framed pixel is like: P of bin k = exp(-sum before) (1 - exp(-n_k)).
struct FirstCount {
  std::vector<double> probability;  // of each sample
  double any = 0;                   // 1 - exp(-N)
  double mean = 0, deviation = 0;   // s, of its time, given there is one
};
FirstCount first_count(const Expected& expected);

}  // namespace suite
