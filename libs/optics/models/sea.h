// What the wind does to the surface of the sea, in numbers. Wind speeds in m/s at 12.5 m above the sea (Cox & Munk) or
// 10 m (whitecaps); the two are not told apart. No errors.
#pragma once
#include <string>
#include <vector>

#include "optics/models/gauss_facets.h"

namespace suite {

// Variances of the slopes along the wind and across it, clean surface: 0.00316 wind and 0.003 + 0.00192 wind;
// isotropic: 0.003 + 0.00512 wind, half of it each way. The skewness and peakedness of the measured distributions are
// left out. Measured from 1 to 14 m/s; the line goes on beyond. Without wind 0.003 remains (isotropic), along the wind
// never less than 1e-4. Source: C. Cox & W. Munk, "Measurement of the roughness of the sea surface from photographs of
// the sun's glitter", J. Opt. Soc. Am. 44, 1954.
struct SeaSlopes {
  double along, across;
  GaussFacets facets() const;
};
SeaSlopes sea_slopes(double wind, bool directed);

// Share of the surface that is white: 2.95e-6 wind^3.52, at most 1 (E. Monahan & I. O'Muircheartaigh, "Optimal
// power-law description of oceanic whitecap coverage dependence on wind speed", J. Phys. Oceanogr. 10, 1980).
double whitecap_share(double wind);
// Reflectance of whitecaps of all ages in the mean, in the visible (P. Koepke, "Effective reflectance of oceanic
// whitecaps", Appl. Opt. 23, 1984); in the infrared it is less.
inline constexpr double kFoamReflectance = 0.22;

// What the numbers above rest on at this wind, beyond what was measured; one sentence each, none from 1 to 14 m/s.
std::vector<std::string> sea_notes(double wind, bool directed);

}  // namespace suite
