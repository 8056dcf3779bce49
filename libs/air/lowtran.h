// LOWTRAN 7 as it was published; builtin_gases() keeps its spectra and fits its laws anew.
#pragma once
#include "air/gases.h"

namespace suite {

// Band functions and continuum of 1988, 0.2 um to 1 mm.
const GasProvider& lowtran_gases();

}  // namespace suite
