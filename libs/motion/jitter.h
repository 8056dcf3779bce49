// Small unwanted motion of a platform or a mount: white or coloured noise on each of six degrees of freedom, a pure
// function of (seed, axis, time), so that any thread, any order of rays and a resumed run see the same motion.
//
// Assumes: stationary, zero-mean Gaussian noise besides a constant offset; axes independent; rotations small.
// Based on: M. Shinozuka, G. Deodatis, "Simulation of stochastic processes by spectral representation", Appl. Mech.
// Rev. 44(4), 1991 (sum of cosines with random phases); variance split after the exposure's transfer function
// sinc^2(fT).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "math/dualquat.h"
#include "motion/time.h"

namespace suite {

// A one-sided power spectral density: S(f) in unit^2/Hz at ascending frequencies in Hz, 0 outside them.
struct Psd {
  std::vector<double> frequency, density;
  enum class Between { log_log, linear } between = Between::log_log;  // straight lines on which paper

  // Error: fewer than two points, sizes that differ, frequencies negative or not ascending, densities negative or not
  // finite, all zero; with log_log also a zero frequency or density.
  void check() const;
  double at(double f) const;
  double variance() const;  // integral of S
};

// Variance within exposures of duration T (s), about each exposure's mean: integral of S (1 - sinc^2(f T)) df.
double in_frame_variance(const Psd& psd, double exposure);
// Variance of the exposures' means: integral of S sinc^2(f T) df.
double frame_to_frame_variance(const Psd& psd, double exposure);

// One degree of freedom.
struct AxisJitter {
  enum class Kind { none, white, psd } kind = Kind::none;
  double mean = 0;   // constant offset, m or rad
  double sigma = 0;  // white: standard deviation, m or rad, >= 0; independent at every instant (1 ns)
  Psd psd;           // coloured: m^2/Hz or rad^2/Hz
};

// Six degrees of freedom in the body's own axes: displacement along x, y, z (m), rotation about x, y, z (rad).
class Jitter {
 public:
  // components: cosines per coloured axis, 16..4096. Half are spread by variance, half evenly over the logarithm of the
  // frequency, each at a random place of its stratum, so that the motion does not repeat and no octave is left out.
  // Error: as Psd::check; a negative or infinite sigma; a mean that is not finite; components out of range.
  Jitter(const std::array<AxisJitter, 6>& axes, uint64_t seed, int components = 256);

  // The six offsets at time t (s), any t.
  std::array<double, 6> at(double t) const;
  // The same as a motion to be applied first: platform.at(t) * jitter.pose(t). Rotations combine as one rotation
  // vector.
  Pose pose(double t) const;
  bool still() const;  // every axis is none

 private:
  friend class JitterWindow;
  struct Wave {
    double amplitude, rate, phase;  // unit, rad/s, rad
  };
  double white(int axis, double t) const;
  std::array<AxisJitter, 6> axes_;
  std::array<std::vector<Wave>, 6> waves_;
  uint64_t seed_;
};

// A jitter made fast for one window: coloured axes are tabulated with their derivatives and read by cubic Hermite
// interpolation, 24 points per shortest period (error below 2e-5 of a wave's amplitude). Refers to the jitter.
class JitterWindow {
 public:
  // Times outside the window, and windows that would need more than 4 million points, are evaluated directly.
  JitterWindow(const Jitter& jitter, TimeSpan window);
  std::array<double, 6> at(double t) const;
  Pose pose(double t) const;

 private:
  const Jitter& jitter_;
  TimeSpan window_;
  struct Table {
    double step = 0;
    std::vector<double> value, slope;
  };
  std::array<Table, 6> tables_;
};

}  // namespace suite
