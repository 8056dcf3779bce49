// What the correction of images for the air needs of one state of it: how much light the air adds, and what it leaves
// of the sun's on the way down and of the ground's on the way up, over an even Lambert ground.
//
// With albedo a of the ground, E0 across the beam, mu0 the cosine of the sun's zenith angle, each bin by itself:
//   L = E0 path + emission_up + (E0 mu0 down_total + pi emission_down) / pi * a up_total / (1 - a spherical_albedo)
// Assumes: plane layers for diffuse light and for the view (the sun's beam runs through the round Earth); no
// polarisation; straight views, the angles those at the ground. Views flatter than 75 degrees are refused: a round
// Earth differs by more than 3 % there.
// Method: discrete ordinates (discrete_ordinates.h), one solution a bin and sun, every view read off it. Light of the
// ground that the air scatters into the view is read off the same solution with a ground of radiance 1.
// Based on: Y. Kaufman, "Atmospheric effect on spatial resolution of surface imagery", Appl. Opt. 23, 1984 (the sum);
// L. Guanter, R. Richter, H. Kaufmann, Int. J. Remote Sens. 30, 2009 (direct and diffuse parts).
#pragma once
#include <span>
#include <vector>

#include "air/air_spec.h"
#include "spectral/state.h"

namespace suite {

// Where a sensor stands to the sun and a place on the ground.
struct CorrectionView {
  double sun_zenith = 0;   // deg, at the ground, 0 to 89
  double view_zenith = 0;  // deg, of the sensor at the ground, 0 to 75
  double azimuth = 0;      // deg, between the sensor and the sun as the ground sees them; 0: the sun behind the sensor
  double height = 0;       // m above sea level, of the sensor; above the ground
};

// Per bin of the state.
struct CorrectionBins {
  std::vector<double> path;              // radiance over a black ground for a beam of irradiance 1, 1/sr
  std::vector<double> down_direct;       // of the beam's irradiance on level ground, 0..1
  std::vector<double> down_total;        // the same with diffuse light, over a black ground
  std::vector<double> up_direct;         // of the ground's radiance
  std::vector<double> up_total;          // with what the air scatters into the view
  std::vector<double> spherical_albedo;  // of the air from below
  std::vector<double> emission_up;       // of the air, W/(m2 sr um), over a black, cold ground
  std::vector<double> emission_down;     // irradiance on the ground by pi, W/(m2 sr um)
};

// For each view; in parallel over bins. Emission is left out, as 0, where black bodies as warm as the air shine less
// than 1e-7 of sunlight. thin: neighbouring layers up to this optical depth together, a tenth of it where the air
// emits, are solved as one, with an error of some quarter of the square of its slant depth; 0: none are. Error: angles
// outside of their ranges, a sensor below the ground; as bake_column.
std::vector<CorrectionBins> air_correction(const AirSpec& air, const SpectralState& state,
                                           std::span<const CorrectionView> views, double thin = 0);

}  // namespace suite
