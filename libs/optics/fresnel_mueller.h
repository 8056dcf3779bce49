// What a smooth interface does to polarised light: Fresnel's amplitudes as matrices in the plane of incidence, basis
// (p, s, k) with p = s x k on both rays (math/mueller.h), index n + ik with k >= 0 and time exp(-i w t): at normal
// incidence rp = -rs.
// Based on: M. Born & E. Wolf, Principles of Optics, 7th ed., sections 1.5 and 14.2.
#pragma once
#include <complex>

#include "math/mueller.h"

namespace suite {

// Reflectance in m11. cos_incident in [0, 1]; index: beyond the interface over this side, not 0. Total reflection is
// index real and below 1.
inline PlaneBlocks fresnel_reflection(double cos_incident, std::complex<double> index) {
  const double c = cos_incident;
  const std::complex<double> n2 = index * index;
  // The root that fades away beyond the interface.
  std::complex<double> q = std::sqrt(n2 - (1 - c * c));
  if (q.imag() < 0) q = -q;
  const std::complex<double> s_sum = c + q, p_sum = n2 * c + q;
  if (s_sum == 0.0 || p_sum == 0.0) return PlaneBlocks::of(1, 0, -1, 0);
  const std::complex<double> rs = (c - q) / s_sum, rp = (n2 * c - q) / p_sum, x = rp * std::conj(rs);
  const double Rp = std::norm(rp), Rs = std::norm(rs);
  return PlaneBlocks::of(0.5 * (Rp + Rs), 0.5 * (Rp - Rs), x.real(), x.imag());
}

// Transmittance of flux in m11; zeros at total reflection. index > 0, both sides transparent.
inline PlaneBlocks fresnel_transmission(double cos_incident, double index) {
  const double c = cos_incident, n2 = index * index, q2 = n2 - 1 + c * c;
  if (!(q2 > 0) || !(c > 0)) return PlaneBlocks::of(0, 0, 0, 0);
  const double q = std::sqrt(q2), ts = 2 * c / (c + q), tp = 2 * index * c / (n2 * c + q), flux = q / c;
  return PlaneBlocks::of(0.5 * flux * (tp * tp + ts * ts), 0.5 * flux * (tp * tp - ts * ts), flux * tp * ts, 0);
}

}  // namespace suite
