// What the quick atmosphere (AtmosphereSpec), which scatters a beam once, leaves out of a view: light that is scattered
// again, that the ground sends into the air, and that comes to the ground after more than one scattering.
//
// The whole is solved by discrete ordinates (air/discrete_ordinates.h, 16 streams) in the same layers over a Lambert
// ground, and holds within 2 % of itself against walks of photons (tests/physics/light/scattered_again_test.cpp: depths
// 0.05 to 1.2, suns from 10 to 75 degrees from the zenith, grounds of 0 to 0.5, up, down and slanted). Plane layers:
// views closer to the level than 0.6 degrees are taken there.
#pragma once
#include "light/atmosphere.h"

namespace suite {

// At the first bin of a state, of one beam, without what the air emits; W/(m2 sr um).
struct ScatteredAgain {
  double once = 0;  // what the atmosphere shows, and the ground in its light
  double all = 0;
  // Share of the whole that is not shown, 0..1.
  double missing() const { return all > once && all > 0 ? 1 - once / all : 0; }
};

struct AirView {
  Vec3 from;  // scene ENU, m
  Dir towards;
};

// From a place at or above the scene's z = 0, where the ground lies. ground_albedo: 0..1. Nothing (zeros) where the
// beam comes from below or the view meets no air. Error: as make_layered_atmosphere and DiscreteOrdinates.
ScatteredAgain scattered_again(const AtmosphereSpec& spec, const SpectralState& state, const Beam& beam,
                               const AirView& view, double ground_albedo);

}  // namespace suite
