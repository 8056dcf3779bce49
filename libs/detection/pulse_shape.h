// The power of a transmitted pulse over time, and what a receiver of finite bandwidth makes of it. The energy is 1;
// time 0 is the centroid.
#pragma once
#include <span>
#include <vector>

#include "base/error.h"

namespace suite {

class PulseShape {
 public:
  static PulseShape impulse();                   // all at time 0
  static PulseShape gaussian(double fwhm);       // s, > 0; FWHM = 2.3548 standard deviations
  static PulseShape rectangular(double length);  // s, > 0
  // Straight lines between power values at ascending times (s), 0 beyond; at least two values. Negative values (noise
  // of a measurement) count as 0. Error, at `where`: times that do not ascend, no energy, not finite.
  static PulseShape table(std::vector<double> time, std::vector<double> power, const Where& where = {});

  double before(double t) const;       // share of the energy before t, 0..1
  double low() const { return low_; }  // s: what lies outside of low..high is below 1e-12 of the energy
  double high() const { return high_; }
  double deviation() const { return deviation_; }  // s, standard deviation
  // s, full width at half maximum of the power; 0 for an impulse.
  double fwhm() const;
  // Through a receiver whose answer to an impulse is a Gaussian; fwhm: s, >= 0. Exact for Gaussians (widths add in
  // squares); else the exact convolution, tabulated at a twentieth of the narrower width.
  PulseShape through(double receiver_fwhm) const;

 private:
  enum class Kind { impulse, gaussian, rectangular, table };
  double power(double t) const;                  // 1/s
  double blurred(double t, double sigma) const;  // power after a Gaussian of that deviation
  Kind kind_ = Kind::impulse;
  double low_ = 0, high_ = 0, deviation_ = 0;
  std::vector<double> time_, power_, sum_;  // of a table: knots, power there, energy before
};

inline constexpr double kFwhmOfDeviation = 2.3548200450309493;  // 2 sqrt(2 ln 2)

}  // namespace suite
