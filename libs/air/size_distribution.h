// How many particles have which radius, and what such a crowd of spheres does to light.
//
// Based on: J. Hansen & L. Travis, "Light scattering in planetary atmospheres", Space Science Reviews 16, 1974, section
// 2 (effective radius and variance, the gamma distribution of equation 2.56); D. Deirmendjian, "Electromagnetic
// Scattering on Spherical Polydispersions", 1969 (modified gamma); C. Junge, "Air Chemistry and Radioactivity", 1963.
#pragma once
#include <complex>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "math/mueller.h"

namespace suite {

class SizeDistribution {
 public:
  // By the median radius and the geometric standard deviation (> 1; its decimal logarithm is what Shettle & Fenn give).
  static SizeDistribution log_normal(double median_um, double geometric_sigma);
  // By the effective radius (third over second moment) and the effective variance, 0.001 .. 0.49.
  static SizeDistribution gamma(double effective_radius_um, double effective_variance);
  // r^shape exp(-slope r^power), r in um.
  static SizeDistribution modified_gamma(double shape, double slope, double power);
  // r^-(exponent + 1) between two radii.
  static SizeDistribution junge(double exponent, double low_um, double high_um);
  // All: Error when a parameter is not positive and finite or outside its range.

  // Particles per um of radius, 1/um; 1 altogether.
  double density(double radius_um) const;
  // Radii outside which less than 1e-7 of the cross-section lies.
  double low_um() const { return low_; }
  double high_um() const { return high_; }
  // Mean of radius^power, um^power, over low .. high.
  double moment(double power) const;
  double effective_radius_um() const { return moment(3) / moment(2); }
  double effective_variance() const;

 private:
  SizeDistribution(std::function<double(double)> log_shape, double mode_um, double low_um, double high_um);
  void cut(double peak);
  // Sum over the nodes of a step of f(radius) * density * d radius.
  double integral(const std::function<double(double)>& f) const;
  std::function<double(double)> log_shape_;  // of the density, not normalised
  double log_scale_ = 0, low_, high_;
};

// Means over the particles of one distribution at one wavelength.
struct BulkOptics {
  double extinction_um2 = 0, scattering_um2 = 0, absorption_um2 = 0;  // cross-sections of a particle
  double asymmetry = 0;
  double volume_um3 = 0;      // of a particle
  std::vector<double> phase;  // 1/sr at the cosines asked for
  // Scattering matrices over the phase function there, in the plane of scattering, where they are asked for.
  std::vector<PlaneBlocks> matrices;
  double albedo() const { return scattering_um2 / extinction_um2; }
  // m2/kg for particles of this density, kg/m3.
  double mass_extinction(double density) const { return extinction_um2 / volume_um3 * 1e6 / density; }
};

// Trapezia over the logarithm of the radius, halved until extinction, scattering and asymmetry change by less than
// `tolerance` (relative), and by twenty times that the absorption (or it by 1e-4 times that of the extinction) or, when
// one is asked for, the phase function at eight angles up to 180 degrees. Error: index or wavelength that Mie's series
// does not take; no convergence (large spheres with weak absorption at tolerances below some 1e-4).
enum class BulkMatrices { none, all };
BulkOptics bulk_optics(const SizeDistribution& sizes, std::complex<double> index, double wavelength_um,
                       std::span<const double> cosines = {}, double tolerance = 1e-4,
                       BulkMatrices matrices = BulkMatrices::none);

}  // namespace suite
