// Satellite positions from two-line element sets: the simplified general perturbations theory SGP4, near Earth and
// deep space.
//
// Assumes: mean elements of the kind published as two-line elements; WGS-72 constants, as those elements demand.
// Positions are in TEME (true equator, mean equinox of date), Earth-centred, not rotating.
// Based on: F. R. Hoots, R. L. Roehrich, "Models for propagation of NORAD element sets", Spacetrack Report 3, 1980;
// D. A. Vallado, P. Crawford, R. Hujsak, T. S. Kelso, "Revisiting Spacetrack Report #3", AIAA 2006-6753, whose
// corrections and verification cases are followed.
#pragma once
#include <memory>
#include <string>

#include "math/vec.h"
#include "motion/time.h"

namespace suite {

// Mean elements at an epoch. Angles in rad.
struct OrbitElements {
  std::string satellite;  // catalogue number, as written
  Utc epoch;
  double inclination = 0;
  double ascending_node = 0;  // right ascension
  double eccentricity = 0;    // 0 <= e < 1
  double perigee_argument = 0;
  double mean_anomaly = 0;
  double mean_motion = 0;  // rad/min, Kozai mean as in element sets; > 0
  double drag = 0;         // B*, 1/Earth radius
};

struct OrbitState {
  Vec3 position;  // m, TEME
  Vec3 velocity;  // m/s, TEME
};

class Sgp4 {
 public:
  // Error, naming the satellite: elements outside their ranges, or a satellite that is below the ground at
  // its own epoch (a perigee below the ground alone is not refused: the last orbit before decay has one).
  explicit Sgp4(const OrbitElements& elements);
  ~Sgp4();
  Sgp4(Sgp4&&) noexcept;

  // State at minutes after the epoch; any sign. A pure function: may be called from many threads.
  // Error, naming the satellite: the mean or perturbed eccentricity leaves its range, the mean motion or the semi-latus
  // rectum is not positive, the satellite has decayed, or the time is further than 1e8 minutes from the epoch.
  OrbitState at_minutes(double minutes) const;
  OrbitState at(Instant instant) const { return at_minutes((instant - epoch_) / 60); }

  const OrbitElements& elements() const { return elements_; }
  bool deep_space() const;  // period of 225 minutes or more

 private:
  struct Model;
  OrbitElements elements_;
  Instant epoch_;
  std::unique_ptr<const Model> model_;
};

// From TEME to Earth-fixed (ECEF), by Greenwich mean sidereal time (IAU 1982), polar motion neglected (up to 15 m).
// The velocity becomes the one relative to the rotating Earth. dut1: UT1 - UTC, s.
OrbitState earth_fixed_from_teme(const OrbitState& teme, Instant instant, double dut1);

}  // namespace suite
