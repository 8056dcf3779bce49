// Scattering matrices as series of generalised spherical functions, as polarised radiative transfer wants them.
//
// A matrix of particles in random orientation (math/mueller.h: PlaneBlocks, of mean a = 1 over the sphere) is, with
// d^l_mn Wigner's functions of the cosine of the scattering angle,
//   a = sum a1_l d^l_00,  a2 + c = sum (a2_l + a3_l) d^l_22,  a2 - c = sum (a2_l - a3_l) d^l_2,-2,  c2 = sum a4_l
//   d^l_00, b = sum b1_l d^l_02,  d = sum b2_l d^l_02.
// a1_l / (2 l + 1) are the moments of the phase function. b1 has the sign that makes molecules polarise across the
// plane of scattering: b < 0.
//
// Based on: M. Mishchenko, L. Travis, A. Lacis, "Scattering, Absorption, and Emission of Light by Small Particles",
// 2002, equations 4.75-4.80 and appendix B; J. Hovenier, C. van der Mee, Astron. Astrophys. 128, 1983.
#pragma once
#include <span>
#include <vector>

#include "math/mueller.h"

namespace suite {

// d^l_mn(x) for l = 0 .. values.size() - 1, |x| <= 1; 0 below l = max(|m|, |n|).
void wigner_d(int m, int n, double x, std::span<double> values);

struct GreekMatrix {
  struct Degree {
    double a1 = 0, a2 = 0, a3 = 0, a4 = 0, b1 = 0, b2 = 0;
  };
  std::vector<Degree> degrees;  // from 0 on; what is missing is 0

  // Molecules; depolarisation factor 0..0.5.
  static GreekMatrix rayleigh(double depolarisation);
  // A phase function that depolarises, by its moments.
  static GreekMatrix depolarising(std::span<const double> moments);
  // A table, linear between cosines that ascend from -1 to 1, scaled to a mean of 1; `count` degrees.
  static GreekMatrix tabulated(std::span<const double> cosines, std::span<const PlaneBlocks> blocks, size_t count);

  // The sum of the series.
  PlaneBlocks at(double cosine) const;
  // Adds another one, `share` times.
  void add(const GreekMatrix& other, double share);
};

// What a matrix, 1/sr, makes of unpolarised light that travels along k_in, in the meridian frame of k_out.
Stokes scattered_once(const PlaneBlocks& blocks, Dir k_out, Dir k_in);

}  // namespace suite
