#include "detection/variates.h"

#include <cmath>

namespace suite {

double excess_noise(double k, double gain) { return k * gain + (1 - k) * (2 - 1 / gain); }

double avalanche(double primaries, double gain, double excess, Pcg32& random) {
  if (!(primaries > 0)) return 0;
  if (!(excess > 1)) return primaries * gain;
  return gamma_variate(primaries / (excess - 1), gain * (excess - 1), random);
}

}  // namespace suite
