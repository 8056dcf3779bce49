// How the builtin gases differ from LOWTRAN 7: laws fitted to k-distributions that were computed line by line.
//
// Assumes: within a band of RRTMGP the spectrum of a gas is LOWTRAN's, only its contrast, its strength, its law and its
// dependence on pressure and temperature differ; the continuum of water differs by smooth factors. Based on: R. Pincus,
// E. J. Mlawer, J. S. Delamere, J. Adv. Model. Earth Syst. 11, 2019 (RRTMGP); fitted by scripts/bake_bands.
#pragma once
#include <cstddef>
#include <span>

#include "air/molecules.h"
#include "air/profile.h"

namespace suite {

// A gas from `low` to before `high` (cm-1). s = strength X^contrast U (p/p0)^pressure (T0/T)^temperature, of LOWTRAN's
// X, the inverse of the amount that halves the light at p0 = 1 atm and T0 = 0 C; law: of the k of s.
struct BandFit {
  Gas gas;
  int low, high;
  size_t law;
  double strength, contrast, pressure, temperature;
};
// Null where LOWTRAN's own holds.
const BandFit* band_fit(Gas gas, int wavenumber_cm);

inline constexpr size_t kBandLawPoints = 16;
// First the k, then as many weights; a weight may be 0.
std::span<const double> band_law(size_t law);

// Factors of LOWTRAN's continuum of water.
struct ContinuumFactors {
  double self_296 = 1, self_260 = 1, foreign = 1;
};
ContinuumFactors continuum_factors(double wavenumber_cm);

}  // namespace suite
