// Half directions drawn near the normal, so that pairs of directions lie near their mirror direction: heavy-tailed,
// lobes of any width are met. Density (1 + a) a / (2 pi (s + a)^2) per steradian over s = 1 - cos(theta_h) in [0, 1].
#pragma once
#include <cmath>

#include "math/vec.h"

namespace suite::sqt {

inline constexpr double kNear = 1e-3;
inline double near_height(double u) { return kNear * u / (1 + kNear - u); }  // s, by inversion of (1 + a) s / (s + a)
inline double near_pdf(double s) { return (1 + kNear) * kNear / ((s + kNear) * (s + kNear)) / (2 * kPi); }
// The half direction from two uniform numbers.
inline Dir near_half(double u, double v) {
  const double s = near_height(u), r = std::sqrt(s * (2 - s));
  return {r * std::cos(2 * kPi * v), r * std::sin(2 * kPi * v), 1 - s};
}

}  // namespace suite::sqt
