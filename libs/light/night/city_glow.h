// Domes of light over the horizon towards far cities, whose lamps light the air.
//
// Assumes: a shape, exp(-elevation / height) times a Gaussian of azimuth, which is no solution of light transport: it
// fits nothing in particular, and tables of measured radiance (a `sky` of kind `table`) or lamps in traced air are
// better. Its brightness at an elevation of 45 degrees can be Walker's law, 0.01 P d^-2.5 of a natural sky of V = 22
// magnitudes a square arc second for P people at d km: towns of California of the 1970s from 10 to 50 km, within a
// factor of 2 there, of more elsewhere (lamps a head differ). Based on: M. F. Walker, "The effects of urban lighting on
// the brightness of the night sky", Publ. Astron. Soc. Pacific 89, 1977.
#pragma once
#include "math/vec.h"
#include "spectral/curve.h"

namespace suite {

struct CityGlow {
  double azimuth = 0;                  // of the dome's middle, rad from east towards north
  double width = 0.35, height = 0.26;  // rad: standard deviation of azimuth; elevation over which it falls to 1 / e
  Curve horizon;                       // W/(m2 sr um), at elevation 0 in its middle
};

// Radiance over that at the horizon in the middle; 0 below the horizon. direction: unit, scene ENU.
double relative_glow(const CityGlow& glow, Dir direction);

// Luminance, cd/m2, at 45 degrees above the horizon towards a city, by Walker's law.
double walker_luminance(double people, double distance_km);

}  // namespace suite
