// Planets as points of light: how bright and of which colour they are.
//
// Assumes: even disks without rotation (Mars changes by 0.06 in V as it turns and 0.1 by season); sunlight of a
// blackbody of 5772 K, reddened by B-V from 0.35 to 0.65 um and of one colour beyond (methane makes Uranus and Neptune
// several times darker from 0.7 um on, and Jupiter and Saturn in bands). Based on: A. Mallama & J. L. Hilton,
// "Computing apparent planetary magnitudes for The Astronomical Almanac", Astronomy and Computing 25, 2018 (V); The
// Astronomical Almanac, "Planets: physical and photometric data" (B-V).
#pragma once
#include "motion/planets.h"
#include "spectral/curve.h"

namespace suite {

// Circumstances by which a planet is as bright as it is.
struct PlanetView {
  double from_sun = 1, from_observer = 1;          // au
  double phase_angle = 0;                          // degrees
  double sun_latitude = 0, observer_latitude = 0;  // degrees, planetocentric, of the places under Sun and observer
  double year = 2000;                              // Neptune brightened until then
};
PlanetView view_of(Planet planet, const PlanetPlace& place, double year);

// V above the air. Saturn with its rings; its phase angle and latitude are held at the ends of the formula, which are
// those seen from the Earth (6.5 and 27 degrees).
double planet_magnitude(Planet planet, const PlanetView& view);

// Spectrum over that at 0.55 um, 0.3 to 2.5 um, zero outside.
Curve planet_shape(Planet planet);

}  // namespace suite
