// The Sun's spectral irradiance at 1 AU, compiled in.
//
// 0.202 to 2.725 um: bin averages of the TSIS-1 Hybrid Solar Reference Spectrum (Coddington et al., Geophys. Res. Lett.
// 48, 2021); beyond, to 1000 um, a blackbody of 5772 K (IAU 2015) scaled to continue it. Assumes nothing below 0.2 um.
#pragma once
#include "spectral/curve.h"

namespace suite {

// W/(m2 um) on a plane facing the Sun at 1 AU, 0.202 to 1000 um; asked outside, an Error.
const Curve& solar_irradiance();

}  // namespace suite
