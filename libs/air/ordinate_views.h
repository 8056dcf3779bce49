// Light inside a layer and along slant rays through it, from the amplitudes at its faces.
#pragma once
#include "air/ordinate_state.h"
#include "air/small_matrices.h"

namespace suite::ordinates {

// Sums s and differences d of weighted radiances at a place.
struct Ordinates {
  double s[small::kMostRows], d[small::kMostRows];
};
Ordinates ordinates_at(const DiscreteOrdinates::State& state, int m, Field field, DiffusePlace place);

// Integral of the multiply scattered source of a part of a layer against exp(-kappa x) kappa, x the depth from the face
// where the ray leaves: what the part adds to the radiance of one order there. mu: of the ray, |mu| = 1 / kappa.
double slant_source(const DiscreteOrdinates::State& state, int m, Field field, int layer, double from, double to,
                    double mu);

// Single scattering for a phase function of `phase` and emission, likewise; from, to: fractions.
double slant_single(const ScaledLayer& layer, double from, double to, double mu, double phase);
double slant_emission(const ScaledLayer& layer, double from, double to, double mu);

}  // namespace suite::ordinates
