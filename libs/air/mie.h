// Scattering by homogeneous spheres: Mie's series.
//
// Sizes are size parameters x = 2 pi radius / wavelength (in the medium outside); the index n + ik is that of the
// sphere over that of the medium, k >= 0 absorbs. Valid for x from 1e-6 (Rayleigh's limit) to 1e6, |index| x up to 1e7.
// Absorption is a sum of its own and not a difference: it keeps its digits however weak it is, and a sphere without
// absorption has an albedo of exactly 1.
//
// Based on: C. Bohren & D. Huffman, "Absorption and Scattering of Light by Small Particles", 1983, section 4.8 and
// appendix A; W. Wiscombe, "Improved Mie scattering algorithms", Applied Optics 19, 1980 (number of terms, asymmetry);
// H. Du, "Mie-scattering calculation", Applied Optics 43, 2004 (ratios of Bessel functions from above).
#pragma once
#include <complex>
#include <span>
#include <vector>

#include "math/mueller.h"

namespace suite {

class MieSphere {
 public:
  // Error: x or the index outside the range above; an index of 1, which scatters nothing.
  MieSphere(double size_parameter, std::complex<double> index);
  // Cross-sections over the geometric one, pi radius^2.
  double extinction() const { return scattering_ + absorption_; }
  double scattering() const { return scattering_; }
  double absorption() const { return absorption_; }
  double albedo() const { return scattering_ / extinction(); }
  // Mean cosine of the scattering angle.
  double asymmetry() const { return asymmetry_; }
  // Amplitudes S1 and S2 of light polarised across and along the plane of scattering (Bohren & Huffman, equation 4.74).
  struct Amplitudes {
    std::complex<double> across, along;
  };
  Amplitudes amplitudes(double cos_scatter) const;
  // The scattering matrix over its first element, in the plane of scattering (equation 4.77; U and V have both the
  // other sign there, which leaves it as it is).
  PlaneBlocks polarised(double cos_scatter) const;
  // For unpolarised light, 1/sr, over the cosine of the scattering angle (1: straight on); 1 over the sphere.
  double phase(double cos_scatter) const;
  // Adds weight * phase(cosine) at each cosine; quicker than one by one.
  void add_phase(std::span<const double> cos_scatter, double weight, std::span<double> sums) const;
  // Adds weight * phase(cosine) times the scattering matrix, of which polarised() has the rest over the first element.
  void add_matrices(std::span<const double> cos_scatter, double weight, std::span<PlaneBlocks> sums) const;

 private:
  // The sum and the difference of both amplitudes, twice each, at cosines of which some are abreast: use(number of the
  // cosine, sum, difference).
  template <class Use>
  void each_amplitude(std::span<const double> cosines, const Use& use) const;
  void sum_efficiencies();
  double x_, scattering_ = 0, absorption_ = 0, asymmetry_ = 0;
  std::vector<std::complex<double>> a_, b_;  // of order 1, 2, ...; [0] unused
};

}  // namespace suite
