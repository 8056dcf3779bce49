// Blackbody radiation, stable from 0.2 to 1000 um and 1 to 10 000 K.
#pragma once

namespace suite {

// CODATA 2018 exact values.
inline constexpr double kPlanckConstant = 6.62607015e-34;         // J s
inline constexpr double kSpeedOfLight = 299792458.0;              // m/s
inline constexpr double kBoltzmann = 1.380649e-23;                // J/K
inline constexpr double kStefanBoltzmann = 5.670374419184429e-8;  // W/(m2 K4), 2 pi^5 k^4 / (15 h^3 c^2)

// Spectral radiance of a blackbody, W/(m2 sr um). wavelength_um > 0, kelvin >= 0 (0 gives 0). Never NaN; underflows to
// 0 in the Wien limit, uses expm1 in the Rayleigh-Jeans limit. Source: Planck 1901.
double planck_radiance(double wavelength_um, double kelvin);

// d ln(planck_radiance) / d ln(kelvin): x / (1 - e^-x) with x = hc / (wavelength k T); 1 in the Rayleigh-Jeans limit.
double planck_steepness(double wavelength_um, double kelvin);

// Radiance in [low_um, high_um], W/(m2 sr): exact series of the fractional function, relative error < 1e-12.
// Source: Widger & Woodall, Bull. AMS 57, 1976, with the small-argument power series below x = 1.
double planck_band_radiance(double low_um, double high_um, double kelvin);

// Kelvin whose planck_radiance at the wavelength is the given radiance (> 0).
double brightness_temperature(double wavelength_um, double radiance);

}  // namespace suite
