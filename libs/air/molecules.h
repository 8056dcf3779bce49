// The air's molecules: how much of it lies where, and how it scatters.
//
// Based on: Rayleigh scattering, B. Bodhaine et al., "On Rayleigh optical depth calculations", J. Atmos. Oceanic
// Technol. 16, 1999, equation 30 (lambda^-4 from 1 um on, where the fit ends) with the depolarisation of Bates 1984;
// the profile of the U.S. Standard Atmosphere 1976.
#pragma once

namespace suite {

// Rayleigh optical depth of the whole atmosphere over a place with this pressure (Pa).
double rayleigh_depth(double wavelength_um, double pressure);
// Its phase function, 1/sr, over the cosine of the scattering angle.
double rayleigh_phase(double cosine);
// U.S. Standard Atmosphere 1976 at a geometric height, m (0 to 86 km; constant below, decaying above).
struct Air {
  double temperature = 288.15;  // K
  double pressure = 101325;     // Pa
};
Air standard_air(double height);

}  // namespace suite
