// Where on the ground the light comes from that the air scatters into a view straight down: the horizontal point spread
// function of the air (its adjacency kernel), as shares of rings about the place that is looked at.
//
// With radiance L(x) of the ground, the view has up_direct L(0) + integral of k(|x|) L(x) d2x, and k integrates to the
// diffuse transmittance up (air_correction.h: up_total - up_direct). Light that has met the ground again is in L.
// Assumes: plane layers, even sideways; a ground that sends equally in all directions; no polarisation.
// Valid for sensors above the ground, any number of scatterings, any depth.
// Method: photons from the sensor, traced backwards: the first scattering is forced, later flights score what of them
// reaches the ground unscattered and go on with the rest; absorption dims, weights below a twentieth play roulette.
// Errors are those of means of batches.
// Based on: J. Otterman & R. Fraser, Appl. Opt. 18, 1979; P. Reinersman & K. Carder, "Monte Carlo simulation of the
// atmospheric point-spread function", Appl. Opt. 34, 1995 (backward photons).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "air/air_spec.h"
#include "spectral/state.h"

namespace suite {

struct KernelSpec {
  std::vector<double> radii;  // m, ascending, positive: outer edges of rings; one more ring has all that lies beyond
  uint32_t photons = 4096;    // of a bin, 64 to 1e7
  uint64_t seed = 1;
};

inline constexpr size_t kKernelBatches = 16;

// Of one height of the sensor. Shares of the ground's radiance.
struct AirKernel {
  std::vector<double> direct;  // [bin] transmittance without scattering
  // [batch][ring][bin]: what the rings send, each batch an estimate of its own.
  std::vector<std::vector<double>> rings[kKernelBatches];
};

// For sensors at heights (m above sea level). In parallel over bins. Error: a sensor that is not above the ground,
// radii that do not ascend, photons out of their range; as bake_column.
std::vector<AirKernel> air_kernel(const AirSpec& air, const SpectralState& state, std::span<const double> heights,
                                  const KernelSpec& spec);

}  // namespace suite
