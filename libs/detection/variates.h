// Random variates of laser radar detectors beside those of math/variates.h, and the key of their stream.
#pragma once
#include "math/variates.h"

namespace suite {

// The stream of one detector, pulse and pixel: results do not depend on which were drawn before.
inline Pcg32 stream_of(uint64_t seed, uint64_t detector, uint64_t pulse, uint64_t pixel = 0) {
  return Pcg32(hash_of(seed, detector, pulse, pixel), hash_of(pulse, pixel));
}

// Electrons behind an avalanche of mean gain M and excess noise F (>= 1) of n primary ones: mean n M, variance
// n M^2 (F - 1) as McIntyre's distribution has them (IEEE Trans. Electron Devices 13, 1966), drawn from the gamma
// distribution with these two, which adds up over samples as avalanches do.
double avalanche(double primaries, double gain, double excess, Pcg32& random);
// McIntyre's F = k M + (1 - k) (2 - 1 / M) of the ratio k of ionisation coefficients, 0..1, M >= 1.
double excess_noise(double ionisation_ratio, double gain);

}  // namespace suite
