// Maps from the unit square to directions, with their densities per steradian.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace suite {

// Concentric disk (Shirley & Chiu 1997): area-preserving, keeps neighbours together.
inline Vec2 disk_from_square(Vec2 u) {
  const double a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {};
  const bool wide = a * a > b * b;
  const double r = wide ? a : b;
  const double phi = wide ? (kPi / 4) * (b / a) : (kPi / 2) - (kPi / 4) * (a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}
// Cosine-weighted upper hemisphere; density cos(theta)/pi.
inline Dir cosine_hemisphere(Vec2 u) {
  const Vec2 d = disk_from_square(u);
  return {d.x, d.y, std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y))};
}
inline double cosine_hemisphere_pdf(double cos_theta) { return std::max(0.0, cos_theta) / kPi; }
// Uniform sphere; density 1/(4 pi).
inline Dir uniform_sphere(Vec2 u) {
  const double z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}
// 1 - cos(angle) without cancellation.
inline double one_minus_cos(double angle) {
  const double s = std::sin(angle / 2);
  return 2 * s * s;
}
// Uniform cone around +z of half-angle whose 1 - cos is `h` (pass one_minus_cos(half_angle)); density 1/(2 pi h).
inline Dir uniform_cone(Vec2 u, double h) {
  const Vec2 d = disk_from_square(u);
  const double r2 = d.x * d.x + d.y * d.y, drop = r2 * h;  // 1 - cos(theta)
  const double scale = r2 > 0 ? std::sqrt(drop * (2 - drop) / r2) : 0;
  return {d.x * scale, d.y * scale, 1 - drop};
}

}  // namespace suite
