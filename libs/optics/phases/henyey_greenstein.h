// The Henyey-Greenstein function without cancellation for any g in (-1, 1).
// Based on: L. Henyey & J. Greenstein, "Diffuse radiation in the Galaxy", ApJ 93, 1941, equation 2.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace suite {

// 1/sr; integrates to 1 over the sphere.
inline double hg_value(double g, double cos_scatter) {
  const double d = (1 - g) * (1 - g) + 2 * g * (1 - cos_scatter);
  return (1 - g) * (1 + g) / (4 * kPi * d * std::sqrt(d));
}
// The inverse of the distribution, with the common factor g divided out by hand so that g = 0 is no special case.
inline double hg_sample(double g, double u) {
  const double t = 2 * u - 1, g2 = g * g, d = 1 + g * t;
  return std::clamp((2 * t + g * (t * t + 3) + 2 * g2 * t + g2 * g * (t * t - 1)) / (2 * d * d), -1.0, 1.0);
}

}  // namespace suite
