// Zodiacal light: sunlight scattered by dust between the planets.
//
// Assumes: the Earth at its mean distance, dust symmetric about the ecliptic; nearer to the Sun than the table goes (15
// degrees) the light grows with the elongation to the power -2.1, as it does along the ecliptic at the table's end.
// Based on: C. Leinert et al., "The 1997 reference of diffuse night sky brightness", Astron. Astrophys. Suppl. 127,
// 1998: table 16, equation 22 (colour), section 8.2 (units).
#pragma once
#include "light/night/glow.h"

namespace suite {

// S10 of solar colour, for ecliptic longitude from the Sun and ecliptic latitude, rad. The table's values at its nodes;
// between them linear in the logarithm.
double zodiacal_s10(double longitude_from_sun, double latitude);

// Its colour over the Sun's is 1 + reddening x (log10(wavelength / 0.5 um) x 2/3, below 0.5 um without the 2/3).
double zodiacal_reddening(double longitude_from_sun, double latitude);

// W/(m2 sr um) of one S10 of solar colour; and what a reddening of 1 adds to it, negative below 0.5 um.
const GlowSpectrum& zodiacal_spectrum();
const GlowSpectrum& zodiacal_red();

}  // namespace suite
