// Pure water and sea water: how they absorb, refract and scatter. Wavelengths in um in vacuum, 0.2 to 200; temperatures
// in degrees Celsius, -2 to 40; salinities in PSU (g/kg), 0 to 45. Errors: none; bug outside of these.
#pragma once
#include <vector>

namespace suite {

inline constexpr double kWaterLowUm = 0.2, kWaterHighUm = 199.98;

// Which measurements of the imaginary index absorption is taken from.
//   segelstein   D. Segelstein, "The complex refractive index of water", thesis, University of Missouri, 1981
//   hale_querry  G. Hale & M. Querry, "Optical constants of water in the 200-nm to 200-um wavelength region", Appl.
//   Opt.
//                12, 1973
enum class PureWater { segelstein, hale_querry };

// 1/m, of pure water at 25 degrees: 4 pi k / wavelength, linear in wavelength between the table's rows. In the blue
// both tables lie far above newer measurements of clear water (water_notes tells how far).
double pure_water_absorption(PureWater table, double wavelength_um);
const std::vector<double>& pure_water_wavelengths(PureWater table);  // um, of the rows, ascending

// Real index over that of air: to 1.1 um after X. Quan & E. Fry, Appl. Opt. 34, 1995, equation 3 (measured from 0.4 to
// 0.7 um), from there on Segelstein's, moved to meet it at 1.1 um.
double sea_water_index(double wavelength_um, double temperature_c, double salinity_psu);

// 1/m, scattering by density and concentration fluctuations; the depolarisation of water is 0.039. Within 2 % of
// Morel's measurements (the authors); beyond 1.1 um as the wavelength to -4. Source: X. Zhang, L. Hu, M.-X. He,
// "Scattering by pure seawater: effect of salinity", Opt. Express 17, 2009.
double sea_water_scattering(double wavelength_um, double temperature_c, double salinity_psu);
inline constexpr double kWaterDepolarisation = 0.039;

}  // namespace suite
