// A rough metal whose matrices are Fresnel's, as a measurement on a grid: what a goniometer would give of it.
#pragma once
#include <cmath>
#include <complex>
#include <memory>

#include "optics/fresnel_mueller.h"
#include "sqt_fit/mueller_brdf.h"

namespace suite::test {

// The share that depolarises grows away from the mirror direction, where every matrix is that of a polarised facet.
inline PlaneBlocks polished_matrix(const sqt::HalfAngles& a, std::complex<double> index) {
  const PlaneBlocks f = fresnel_reflection(std::cos(a.theta_d), index);
  const double kept = 0.98 * std::exp(-a.theta_h * a.theta_h);
  PlaneBlocks b = f * (kept / f.a);
  b.a = 1;
  return b;
}

inline std::shared_ptr<const sqt::MuellerBrdf> polished_metal(double noise = 0) {
  sqt::MuellerBrdf::Data d;
  for (int i = 0; i <= 24; ++i) d.grid.theta_h.push_back(kPi / 2 * (i / 24.0) * (i / 24.0));
  for (int i = 0; i <= 20; ++i) d.grid.theta_d.push_back(kPi / 2 * i / 20.0);
  for (int i = 0; i < 16; ++i) d.grid.phi_d.push_back(-kPi + 2 * kPi * i / 16.0);
  d.wavelength_um = {0.45, 0.65};
  constexpr std::complex<double> kIndex[] = {{1.4, 1.9}, {0.2, 3.3}};
  uint32_t state = 1;
  for (size_t n = 0; n < d.grid.nodes(); ++n)
    for (const std::complex<double> index : kIndex) {
      const sqt::HalfAngles a = d.grid.angles(n);
      const double f = 0.02 + 0.6 * std::exp(-a.theta_h * a.theta_h / 0.08);
      Mueller m = polished_matrix(a, index).matrix() * f;
      for (size_t e = 1; e < 16; ++e) {
        state = state * 1664525u + 1013904223u;
        m.m[e] += f * noise * (state / 2147483648.0 - 1);
      }
      for (const double x : m.m) d.values.push_back(static_cast<float>(x));
    }
  return std::make_shared<const sqt::MuellerBrdf>("polished metal", "formula", std::move(d));
}

}  // namespace suite::test
