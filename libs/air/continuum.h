// The continuum of water vapour as MT_CKD gives it: what is left of its lines 25 cm-1 and more from their middles, and
// under them what they have there.
//
// Based on: S. A. Clough et al., Atmos. Res. 23, 1989; E. J. Mlawer et al., Phil. Trans. R. Soc. A 370, 2012.
#pragma once
#include <vector>

namespace suite {

// Coefficients on even wavenumbers, at 296 K and the density of 1013.25 hPa, cm2/(molecule cm-1), to be multiplied by
// the radiation field; 0 beyond.
struct WaterContinuum {
  double first_cm = 0, step_cm = 0;
  std::vector<double> self, foreign, exponent;  // exponent: of self in 296 K / T

  // Cross section of a molecule of water, m2, for 1 Pa of other water, and for 1 Pa of other air.
  double self_section(double wavenumber_cm, double temperature) const;
  double foreign_section(double wavenumber_cm, double temperature) const;
};

// v tanh(h c v / 2 k T), cm-1.
double radiation_field(double wavenumber_cm, double temperature);

// Error unless the step is positive and the columns have one length of two at least.
void check_continuum(const WaterContinuum& continuum);

}  // namespace suite
