// Sun and Moon as seen from a place of the scene: direction in scene ENU, distance, apparent radius.
//
// Assumes: polar motion is neglected (below 1e-4 degree); light-time and aberration are included.
// Accuracy: the Sun better than 1 arc second, the Moon about 10 arc seconds (the theory's own).
// Based on: IAU 2006/2000A precession-nutation and Earth rotation (IERS Conventions 2010); the Earth ephemeris of
// Moisson & Bretagnon (2001) as eraEpv00, the Moon's after Chapront and Meeus (1998) as eraMoon98, both ERFA;
// refraction after T. Saemundsson, Sky and Telescope 72, 1986, with the pressure and temperature factor of
// Reda & Andreas, "Solar position algorithm", NREL/TP-560-34302, 2008, eq. 42.
#pragma once
#include <memory>

#include "math/vec.h"
#include "motion/scene_frame.h"
#include "motion/time.h"

namespace suite {

struct SkyBody {
  Dir direction;              // towards the body's centre, scene ENU, unit length
  double distance = 0;        // m
  double angular_radius = 0;  // rad
  double elevation = 0;       // rad above the horizon of the place (geodetic vertical)
};

// The air at a site, which bends light near the ground; pressure 0 = no refraction.
struct SiteAir {
  double pressure = 0;       // Pa, 0..2e5
  double temperature = 283;  // K, 150..400
};

// Lengths used above (IAU 2015 nominal solar radius; mean lunar radius).
inline constexpr double kSunRadius = 6.957e8, kMoonRadius = 1.7374e6, kAstronomicalUnit = 1.495978707e11;  // m

// The body as seen from `site` (scene ENU, m) at an instant. dut1: UT1 - UTC in s (0 costs up to 0.004 degree).
// Error: refraction outside its range, |dut1| > 0.9.
SkyBody sun_at(const SceneFrame& frame, Vec3 site, Instant instant, double dut1 = 0, const SiteAir& air = {});
SkyBody moon_at(const SceneFrame& frame, Vec3 site, Instant instant, double dut1 = 0, const SiteAir& air = {});

// The sun of many instants over one place, for work on every step of a day or a year: the exact series have thousands
// of terms. The pole and the sun's place are exact at multiples of three hours of terrestrial time and cubic in
// between, which is off by less than 1e-9 rad. Safe for threads; the same whatever was asked before.
class SunSeries {
 public:
  SunSeries(const SceneFrame& frame, Vec3 site);
  ~SunSeries();
  SunSeries(const SunSeries&) = delete;
  SunSeries& operator=(const SunSeries&) = delete;
  // As sun_at().
  SkyBody at(Instant instant, double dut1 = 0, const SiteAir& air = {}) const;

 private:
  struct Knots;
  SceneFrame frame_;
  Vec3 site_;
  std::unique_ptr<Knots> knots_;
};

// Sun-Moon-Earth angle, rad: 0 = full, pi = new. What lunar irradiance models are driven by.
double moon_phase_angle(Instant instant);

// Apparent place of the Moon as seen from the Earth's centre, true equator and equinox of date.
struct EquatorialPlace {
  double right_ascension = 0, declination = 0;  // rad
  double distance = 0;                          // m
};
EquatorialPlace moon_geocentric(Instant instant);

// Lift of a body by refraction, rad, at its geometric elevation (rad). 0 below -1 degree, where the formula ends.
double refraction_lift(double elevation, const SiteAir& air);

}  // namespace suite
