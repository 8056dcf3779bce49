// Light as the eye weighs it: what turns candela and lumens into watts.
// Based on: CIE 1924 V(lambda), as in CIE 018:2019 table (10 nm, 380 to 780 nm); SI brochure, 9th ed. 2019, section 2.3
// (683 lm/W at 540 THz, of V's maximum at 555 nm 683.002). Of the eye that is used to the dark: CIE 1951 V'(lambda), as
// in CIE 018:2019, whose maximum at 507 nm is 1700.06 lm/W (the same 683 lm/W at 540 THz).
#pragma once
#include "spectral/curve.h"

namespace suite {

// 683.002 lm/W times the integral of V x spectrum over wavelength: candela of a spectrum in W/(sr um), lumens of one in
// W/um. Exact for the piecewise linear curves. Error: the spectrum does not cover 0.38 to 0.78 um.
double photopic(const Curve& spectrum);
// The same for the eye that is used to the dark: 1700.06 lm/W times the integral of V' x spectrum.
double scotopic(const Curve& spectrum);
// Lumens a watt at one wavelength (um), of which the above are integrals; 0 outside 0.38 to 0.78 um.
double photopic_weight(double um);
double scotopic_weight(double um);

}  // namespace suite
