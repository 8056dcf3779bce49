// A waveform as a sum of Gaussians on a constant baseline: least squares with known noise, or maximum likelihood of
// Poisson counts by expectation and maximisation.
//
// Seeds stand at maxima and where the second derivative has its minima (a shoulder has no maximum: two equal Gaussians
// have two maxima only when more than two deviations apart). Pulses nearer than half a FWHM are one. One more pulse
// must lower chi-square (of counts: twice the lack of log-likelihood) by 16.27, the 99.9 % quantile of three
// parameters; else the nearest two are joined, or the weakest is left out. Based on: W. Wagner et al., "Gaussian
// decomposition and calibration of a novel small-footprint full-waveform digitising airborne laser scanner", ISPRS J.
// 60, 2006; D. W. Marquardt, J. SIAM 11, 1963; A. Dempster, N. Laird, D. Rubin, J. R. Stat. Soc. B 39, 1977 for EM.
#pragma once
#include <array>
#include <vector>

#include "detection/returns.h"

namespace suite {

struct GaussianPulse {
  double amplitude = 0, centre = 0, width = 0;  // above the baseline; s; s, standard deviation
  // Of amplitude, centre, width: row by row, in the squares of their units.
  std::array<double, 9> covariance{};
};
struct Decomposition {
  std::vector<GaussianPulse> pulses;  // by their centres
  double baseline = 0;
  double chi_square = 0;  // sum of squared residuals over their variances; of EM twice the lack of log-likelihood
  size_t degrees = 0;     // samples less parameters
  bool converged = false;
};

struct DecomposeSpec {
  double least_width = 0;      // s, the system's: no narrower pulse is told
  double least_amplitude = 0;  // above the baseline, > 0
  size_t most = 32;            // pulses, at most 64
  int steps = 100;
};

// noise: standard deviation of each sample, > 0, or one value for all.
Decomposition decompose(std::span<const double> signal, std::span<const double> noise, const SampleGrid& grid,
                        const DecomposeSpec& spec);

// counts: primary electrons or photons of each sample, >= 0. The likelihood never falls from step to step; its course
// is returned where asked for. The covariance is the inverse of Fisher's information.
Decomposition decompose_counts(std::span<const double> counts, const SampleGrid& grid, const DecomposeSpec& spec,
                               std::vector<double>* log_likelihoods = nullptr);

// The returns of a decomposition, with the deviations of their times.
std::vector<LidarReturn> returns_of(const Decomposition& d);

}  // namespace suite
