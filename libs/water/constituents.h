// What is in natural waters besides water: absorption and scattering (1/m) of each constituent. Wavelengths in um, 0.2
// to 200; concentrations at least 0. No errors.
#pragma once

namespace suite {

// Phytoplankton of chlorophyll-a `chlorophyll` (mg/m3): A chl^E, per 10 nm from 0.4 to 0.7 um; below held at 0.4 um,
// falling to 0 from 0.7 to 0.72 um.
// Source: A. Bricaud et al., "Variations of light absorption by suspended particles with chlorophyll a concentration in
// oceanic (case 1) waters", J. Geophys. Res. 103, 1998, table 2 (a_phi).
double phytoplankton_absorption(double wavelength_um, double chlorophyll);

// Particles of case 1 waters: 0.416 chl^0.766 at 0.55 um (H. Loisel & A. Morel, Limnol. Oceanogr. 43, 1998), as the
// wavelength to v = 0.5 (log10 chl - 0.3) below 2 mg/m3, 0 above (A. Morel & S. Maritorena, "Bio-optical properties of
// oceanic waters: a reappraisal", J. Geophys. Res. 106, 2001, equations 12 to 14; v of chl below 0.02 is that of 0.02).
double phytoplankton_scattering(double wavelength_um, double chlorophyll);
// Share of it scattered by more than 90 degrees, at 0.55 um (equation 13; chl 0.02 to 100): 0.002 to 0.0112.
double phytoplankton_backscatter(double chlorophyll);

// Coloured dissolved matter: exp(-slope (wavelength - 440 nm)); absorption_440: 1/m; slope: 1/nm, 0.014 in the mean
// (A. Bricaud, A. Morel, L. Prieur, Limnol. Oceanogr. 26, 1981).
double dissolved_absorption(double wavelength_um, double absorption_440, double slope_per_nm);
// What goes with chlorophyll in case 1 waters, at 440 nm: 0.2 (0.00635 + 0.06 chl^0.65), 1/m; pure water as A. Morel,
// Prog. Oceanogr. 26, 1991 counts it. Source: Morel & Maritorena 2001, equation 19.
double case_1_dissolved(double chlorophyll);

// Mineral (non-algal) particles of case 2 waters, concentration in g/m3. Absorption: 0.031 m2/g at 443 nm, slope
// 0.0123 /nm (M. Babin et al., "Variations in the light absorption coefficients of phytoplankton,
// nonalgal particles, and dissolved organic matter in coastal waters around Europe", J. Geophys. Res. 108, 2003,
// means). Scattering: 0.51 m2/g at 555 nm, the same at all wavelengths (M. Babin et al., "Light scattering properties
// of marine particles in coastal and open ocean waters as related to the particle mass concentration", Limnol.
// Oceanogr. 48, 2003). Both vary by a factor of 2 and more from place to place.
double mineral_absorption(double wavelength_um, double grams_per_m3);
double mineral_scattering(double grams_per_m3);

// 1/m, Raman scattering by water out of light of this wavelength: 2.7e-4 at 0.488 um, as the wavelength to -5.5
// (J. Bartlett et al., "Raman scattering by pure water and seawater", Appl. Opt. 37, 1998). Not part of any medium: for
// the size of what is left out.
double raman_scattering(double from_um);

}  // namespace suite
