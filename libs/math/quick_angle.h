// Angles of directions, for places in tables: within 5e-8 rad, in a fraction of the time of the exact ones (vec.h).
// Based on: M. Abramowitz, I. Stegun, "Handbook of mathematical functions", 1964, 4.4.49.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace suite {

// 0 at the origin, where there is no angle. float: within 5e-7 rad.
template <class T>
T quick_atan2(T y, T x) {
  const auto c = [](double v) { return static_cast<T>(v); };
  const T ax = std::fabs(x), ay = std::fabs(y), large = std::max(ax, ay);
  const T t = large > 0 ? std::min(ax, ay) / large : 0, s = t * t;
  // In pairs, so that no step waits for all before it (G. Estrin, "Organization of computer systems", 1960).
  const T s2 = s * s, s4 = s2 * s2;
  const T low = (1 - c(0.3333314528) * s) + (c(0.1999355085) - c(0.1420889944) * s) * s2;
  const T high = (c(0.1065626393) - c(0.0752896400) * s) + (c(0.0429096138) - c(0.0161657367) * s) * s2;
  const T p = low + (high + c(0.0028662257) * s4) * s4;
  T angle = p * t;
  if (ay > ax) angle = c(kPi / 2) - angle;
  if (x < 0) angle = c(kPi) - angle;
  return y < 0 ? -angle : angle;
}
inline double quick_polar_angle(Dir d) { return quick_atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z); }
inline double quick_azimuth(Dir d) { return quick_atan2(d.y, d.x); }

}  // namespace suite
