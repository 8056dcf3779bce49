// The deep-space part of SGP4: attraction of Sun and Moon, and resonance with the Earth's rotation (12 h and 24 h
// orbits). Internal to sgp4.cpp.
// Based on: Hoots & Roehrich 1980, section 6 (SDP4); Vallado et al. 2006. Symbols are theirs where a quantity has none
// of its own outside the theory.
#pragma once

namespace suite::sgp4 {

// Mean elements as they are carried through the theory: rad, rad/min.
struct Mean {
  double motion, eccentricity, inclination, node, perigee, anomaly;
};

// Rates the near-Earth theory hands over, rad/min.
struct SecularRates {
  double anomaly, perigee, node;
};

// Long-period amplitudes of one attracting body.
struct Periodic {
  double e2, e3, i2, i3, l2, l3, l4, gh2, gh3, gh4, h2, h3;
  double anomaly_at_epoch;  // of the attracting body's mean orbit
};

enum class Resonance { none, day, half_day };

class DeepSpace {
 public:
  // days: epoch in days since 1950 January 0.0; sidereal: Greenwich sidereal angle at epoch.
  DeepSpace(const Mean& epoch, const SecularRates& rates, double days, double sidereal, double xke);

  // Secular drift by Sun and Moon and the resonance, minutes after epoch; `m` holds the near-Earth mean elements.
  void secular(double minutes, Mean& m) const;
  // Long-period variations by Sun and Moon.
  void periodic(double minutes, Mean& m) const;

 private:
  struct Geometry;  // what one attracting body needs, see sgp4_deep.cpp
  void set_secular(const Geometry& sun, const Geometry& moon);
  void set_day_resonance(double semi_major_power);
  void set_half_day_resonance(double semi_major_power);
  void resonance_rates(double longitude, double time, double motion, double& acceleration, double& jerk,
                       double& drift) const;

  Mean epoch_;
  SecularRates rates_;
  double sidereal_;
  Periodic sun_, moon_;
  Mean drift_{};  // rates of the elements by Sun and Moon; `motion` unused
  Resonance resonance_ = Resonance::none;
  double start_longitude_ = 0;  // resonance angle at epoch
  double longitude_rate_ = 0;   // its rate beyond the mean motion
  double day_[3] = {};          // amplitudes of the 24 h terms
  double half_day_[10] = {};    // amplitudes of the 12 h terms, in the order of kHalfDayTerms
};

}  // namespace suite::sgp4
