// An analytic clear sky: the direct beam and the diffuse radiance under a cloudless atmosphere, 0.3 to 4 um.
//
// Assumes: sea-level formulae scaled with pressure; rural aerosol by default; one angular distribution for all
// wavelengths; a Sun above the horizon.
// Based on: R. Bird & C. Riordan, "Simple solar spectral model for direct and diffuse irradiance on horizontal and
// tilted planes at the Earth's surface for cloudless atmospheres", SERI/TR-215-2436, 1984 (and J. Climate Appl. Meteor.
// 25, 1986), equations 2-1 to 3-17, with the constants of the authors' later program where they differ (2-4, 2-11,
// 3-8); the air mass of F. Kasten & A. Young, Appl. Opt. 28, 1989; the angular distribution of R. Perez, R. Seals & J.
// Michalsky, "All-weather model for sky luminance distribution", Solar Energy 50, 1993.
#pragma once
#include "light/kinds/sky.h"

namespace suite {

struct ClearSkySpec {
  double pressure = 101325;          // Pa at the ground
  double water_cm = 1.42;            // precipitable water, cm
  double ozone_cm = 0.344;           // atm-cm
  double aerosol_depth_500 = 0.084;  // vertical aerosol optical depth at 0.5 um
  double angstrom = 1.14;            // its exponent
  double albedo_400 = 0.945;         // single-scattering albedo of the aerosol at 0.4 um
  double asymmetry = 0.65;           // of the aerosol
  double ground_albedo = 0.2;
  // Largest degree of polarisation, 0 to 1; nothing: 0.94 (air, depolarisation 0.03) times the share of the diffuse
  // light at 0.55 um that molecules have scattered.
  std::optional<double> polarisation = {};
  Where where = {};  // in the text
};
// Settles into a sky, and the sun above the air into the one at the ground.
LightSpecPtr make_light(ClearSkySpec spec);

// Irradiances at the ground, as those of ClearSky.
struct ClearSpectra {
  Curve direct, diffuse;
  double by_molecules = 0;  // share of the diffuse light at 0.55 um that molecules have scattered
};

struct ClearSky {
  Curve direct;   // W/(m2 um) on a plane facing the Sun, at the ground
  Curve diffuse;  // W/(m2 um) on the horizontal
  SkySpec sky;    // radiance whose hemispheric integral of L cos is `diffuse`
};

// sun: towards the Sun; top: irradiance above the atmosphere, W/(m2 um) on a plane facing the Sun, covering 0.3 to 4
// um. Error: Sun at or below the horizon, parameters out of range.
ClearSky clear_sky(const ClearSkySpec& spec, Dir sun, const Curve& top);
// The spectra alone: nothing is found of directions. The same errors.
ClearSpectra clear_spectra(const ClearSkySpec& spec, Dir sun, const Curve& top);

// Relative optical air mass at a zenith angle, rad (Kasten & Young 1989).
double air_mass(double zenith);

}  // namespace suite
