// Stars: a catalogue of bright ones, what they send, and the light of all that it leaves out.
//
// Assumes: stars are blackbodies of the temperature of their colour, scaled to V at 0.55 um (M giants send twice as
// much at 0.8 um for bands of TiO below it); constant brightness. Based on: D. Hoffleit & W. H. Warren, "The Bright
// Star Catalogue, 5th revised ed.", 1991 (CDS V/50); F. J. Ballesteros, "New insights into black bodies", EPL 97, 2012,
// equation 14 (temperature of B-V); M. S. Bessell et al., Astron. Astrophys. 333, 1998 (V = 0: 3.631e-8 W/(m2 um)); F.
// E. Roach & L. R. Megill, Astrophys. J. 133, 1961 (all stars are as bright as 1092 of V = 1).
#pragma once
#include <string>
#include <vector>

#include "motion/celestial.h"
#include "spectral/curve.h"

namespace suite {

struct CatalogueStar {
  std::string name;
  CatalogPlace place;
  double v = 0, kelvin = 0;  // magnitude V
};

// 9096 stars to V = 7.96, complete to about 6.5; their names are numbers (HR).
const std::vector<CatalogueStar>& bright_star_catalogue();

// W/(m2 um) at 0.55 um of a star of V = 0, above the air.
inline constexpr double kVegaIrradiance = 3.631e-8;
// 10^(-0.4 v): in stars of V = 0.
double flux_of(double v);
// K.
double star_temperature(double colour);
// Blackbody of a temperature over that at 0.55 um, 0.3 to 2.5 um, zero outside.
Curve star_shape(double kelvin);

// W/(m2 sr um) at 0.55 um of one S10(V): a star of V = 10 a square degree.
double s10_radiance();
// Light of all stars by galactic latitude, S10(V): 47.2 / (|sin b| + 0.12), whose mean is that of kAllStars.
double starlight_s10(double sine_of_galactic_latitude);
// The whole sky's, in stars of V = 0.
inline constexpr double kAllStars = 434.73;
// Of their colour, B-V.
inline constexpr double kStarlightColour = 0.75;
// The galactic pole's direction, ICRS (right ascension 192.85948, declination 27.12825 degrees).
Dir galactic_pole();

}  // namespace suite
