// Particles as spheres of a size distribution and an index that a user gives: all by Mie's series, scattering matrices
// as well.
//
// Assumes: one distribution and one index, whatever the humidity. Tolerance of the sum over radii: 1e-3 of extinction,
// scattering and asymmetry, 2 % of the phase function at single angles (size_distribution.h).
#pragma once
#include <span>

#include "air/particles.h"
#include "air/size_distribution.h"
#include "spectral/curve.h"

namespace suite {

struct SphereSpec {
  SizeDistribution sizes;
  Curve n, k;          // index n + ik, k >= 0; wavelengths within those of both
  double density = 0;  // kg/m3: extinction in m2/kg; 0: extinction over that at 0.55 um
  std::string name = "spheres";
};

// Wavelengths that are asked for again are not made again. Some 10 ms a wavelength for aerosols, a second for drops of
// 10 um in green light. Error: a wavelength outside of the index; as bulk_optics.
ParticleOptics sphere_optics(const SphereSpec& spheres, std::span<const double> wavelengths_um);

}  // namespace suite
