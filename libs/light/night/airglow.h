// Airglow: light of the upper air itself, in thin layers.
//
// Assumes: typical brightness, which varies by a factor of 2 to 3 within a night and from night to night; layers
// without thickness, even all around. Lines of OH from 1.083 to 2.274 um are those of Steed & Baker's list alone, a
// lower bound. Based on: P. J. van Rhijn, Publ. Astron. Lab. Groningen 31, 1921; F. E. Roach & J. L. Gordon, "The light
// of the night sky", 1973, and C. Leinert et al. 1998, section 6 (typical intensities, layers); A. J. Steed & D. J.
// Baker, Appl. Opt. 18, 1979 (OH, as in IRAF's list). The continuum (0.3 R per 0.1 nm from 0.4 to 1.0 um, nothing from
// 0.05 um farther on) and the share of OH below 1 um (20 kR from 0.6 to 1.0 um, growing evenly) are simplified here.
#pragma once
#include <vector>

#include "light/night/glow.h"

namespace suite {

// Brightness of a layer at a height (m) over that at the zenith, seen from the ground at an angle from the zenith,
// whose sine is given.
double van_rhijn(double sine_of_zenith_angle, double height);

// W/(m2 sr) of a number of rayleigh at a wavelength: 1 R = 1e10 / (4 pi) photons/(m2 s sr).
double rayleigh_radiance(double rayleigh, double wavelength_um);

struct AirglowLayer {
  double height = 0;      // m
  GlowSpectrum spectrum;  // W/(m2 sr um) at the zenith
};
// solar_flux_sfu: of the Sun at 10.7 cm (65 quiet, 250 active), by which oxygen's lines and the continuum grow as 0.9 +
// 0.0011 (flux - 100); typical at 130.
std::vector<AirglowLayer> airglow_layers(double solar_flux_sfu);

}  // namespace suite
