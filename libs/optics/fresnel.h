// Reflection and transmission at a smooth interface, unpolarised, written without differences of nearly equal numbers:
// exact to a few ulp from normal to grazing incidence and for index ratios arbitrarily near 1.
// Based on: M. Born & E. Wolf, Principles of Optics, 7th ed., sections 1.5 and 14.2.
#pragma once
#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace suite {

struct Fresnel {
  double reflectance = 1, transmittance = 0;  // sum is 1
  double cos_transmitted = 0;                 // of the refracted direction; 0 at total reflection
};

// cos_incident in [0, 1]; eta = n_transmitted / n_incident > 0. With q = eta cos_t, q^2 = (eta^2 - 1) + cos_i^2, the
// differences cos_i - q and eta^2 cos_i - q become products with eta^2 - 1.
inline Fresnel fresnel_dielectric(double cos_incident, double eta) {
  const double c = cos_incident, excess = (eta - 1) * (eta + 1), q2 = excess + c * c;
  if (!(q2 > 0) || !(c > 0)) return {};
  const double q = std::sqrt(q2), eta2 = eta * eta, s = c + q, p = eta2 * c + q;
  const double rs = excess / (s * s), rp = excess * (c * c * (eta2 + 1) - 1) / (p * p);
  const double ts = 4 * c * q / (s * s), tp = 4 * eta2 * c * q / (p * p);
  return {std::min(1.0, 0.5 * (rs * rs + rp * rp)), std::min(1.0, 0.5 * (ts + tp)), q / eta};
}

// Reflectance of a conductor of index n + i k (relative to the outside), n > 0, k >= 0.
inline double fresnel_conductor(double cos_incident, double n, double k) {
  const double c = std::clamp(cos_incident, 0.0, 1.0), c2 = c * c, s2 = 1 - c2;
  // u + i v = sqrt((n + i k)^2 - sin^2)
  const double re = n * n - k * k - s2, im = 2 * n * k, size = std::hypot(re, im);
  const double u = re > 0 ? std::sqrt(0.5 * (size + re)) : (size > re ? im / std::sqrt(2 * (size - re)) : 0);
  const double v2 = std::max(0.0, 0.5 * (size - re));
  const double rs = ((u - c) * (u - c) + v2) / ((u + c) * (u + c) + v2);
  if (c == 0) return 1;
  const double t = s2 / c;
  const double rp = rs * ((u - t) * (u - t) + v2) / ((u + t) * (u + t) + v2);
  return 0.5 * (rs + rp);
}

// Schlick's approximation from the reflectance at normal incidence (C. Schlick, "An inexpensive BRDF model", 1994).
inline double fresnel_schlick(double cos_incident, double f0) {
  const double m = 1 - std::clamp(cos_incident, 0.0, 1.0), m2 = m * m;
  return f0 + (1 - f0) * m2 * m2 * m;
}

}  // namespace suite
