// The Moon as a far disk of uniform radiance: its irradiance from the Sun's, its phase and its distance.
//
// Assumes: the disk-integrated irradiance is that of the ROLO model 311g; the disk shows no maria, and a terminator
// only where that is asked for (phased_disk.h), else the mean radiance everywhere, which matters to what resolves half
// a degree. Between the 32 bands the reflectance is linear in wavelength, beyond them constant. The fit holds for phase
// angles of 1.55 to 97 degrees and is extrapolated to 0..150 (beyond, the Moon gives no light). Based on: H. H. Kieffer
// & T. C. Stone, "The spectral irradiance of the Moon", Astron. J. 129, 2005, equations 10 and 11, table 4.
#pragma once
#include "light/kinds/sun.h"

namespace suite {

struct MoonGeometry {
  double phase = 0;          // rad, Sun-Moon-observer angle, 0 = full
  double sun_longitude = 0;  // rad, selenographic longitude of the Sun, about the signed phase (positive before full)
  double observer_latitude = 0;        // rad, selenographic (libration, moon_face.h); 0 without a date: up to 4 % off
  double observer_longitude = 0;       // rad
  double sun_distance_au = 1;          // Sun to Moon
  double observer_distance = 384.4e6;  // m, Moon to observer
};

struct MoonSpec {
  SunSpec disk;             // irradiance: taken as given unless by_phase
  bool by_phase = true;     // irradiance from the phase, the distances and the Sun's spectrum at 1 AU
  bool earthshine = false;  // besides, by phase: sunlight that the Earth sends there
  bool phased = false;      // the disk shows its phase; by date alone
  MoonGeometry geometry;    // filled from the date when disk.time is given
  // Filled likewise: from the Moon towards the Sun, scene ENU, and the share of its light that is earthshine.
  std::optional<Dir> to_sun = {};
  double of_earth = 0;
};

LightSpecPtr make_light(MoonSpec spec);
// What a moment makes of it: place, size and phase by date, irradiance by phase. Error: a date without an origin.
MoonSpec resolved(MoonSpec moon, const LightMoment& at);

// Disk reflectance over wavelength. Error: angles that are not finite, phase outside 0..pi.
Curve moon_reflectance(const MoonGeometry& geometry);

// Irradiance on a plane facing the Moon, W/(m2 um): A Omega E_sun / pi (eq. 8) scaled by both distances.
// sun: at 1 AU.
Curve moon_irradiance(const MoonGeometry& geometry, const Curve& sun);

// The same of the Moon's night side and day side in the light of the Earth, whose phase angle is pi less the Moon's: 8
// lx at full Earth against the Sun's 1.3e5 lx, seen as the full Moon is (phase 1.5 degrees, before the fit's end), and
// less by a Lambertian sphere's phase function. The Earth's colour and clouds are left out, which may count a third.
Curve earthshine_irradiance(const MoonGeometry& geometry, const Curve& sun);

}  // namespace suite
