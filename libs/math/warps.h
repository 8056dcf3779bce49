// Maps from the unit square to directions, with their densities per steradian.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace suite {

// Sine and cosine of an angle within pi/4 of zero, to 2e-16: their Taylor series, whose next terms are below 5e-17. Of
// one, or of several in a vector of the compiler's.
template <class T>
struct SineCosine {
  T sine, cosine;
};
template <class T>
constexpr SineCosine<T> sine_cosine_near_zero(T x) {
  constexpr double sine[] = {1.0 / 1,      -1.0 / 6,        1.0 / 120,        -1.0 / 5040,
                             1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000};
  constexpr double cosine[] = {1.0 / 1,        -1.0 / 2,        1.0 / 24,           -1.0 / 720,          1.0 / 40320,
                               -1.0 / 3628800, 1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000};
  const T z = x * x;
  T s = T{} + sine[7], c = T{} + cosine[8];
  for (int k = 6; k >= 0; --k) s = sine[k] + z * s;
  for (int k = 7; k >= 0; --k) c = cosine[k] + z * c;
  return {x * s, c};
}

// Concentric disk (Shirley & Chiu 1997): area-preserving, keeps neighbours together.
inline Vec2 disk_from_square(Vec2 u) {
  const double a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {};
  const bool wide = a * a > b * b;
  const double r = wide ? a : b;
  const SineCosine<double> angle = sine_cosine_near_zero((kPi / 4) * ((wide ? b : a) / r));
  return wide ? Vec2{r * angle.cosine, r * angle.sine} : Vec2{r * angle.sine, r * angle.cosine};
}
// Cosine-weighted upper hemisphere; density cos(theta)/pi.
inline Dir cosine_hemisphere(Vec2 u) {
  const Vec2 d = disk_from_square(u);
  return {d.x, d.y, std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y))};
}
// The same for many points, to the same bits: x and y hold the points and then, with z, the directions. Arrays of
// `count` numbers, rounded up to a multiple of four.
void cosine_hemispheres(size_t count, double* x, double* y, double* z);
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
