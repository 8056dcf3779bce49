// What every scattering model must satisfy, as statistics with a stated significance.
//
// One draw of n samples for a (model, knot, out direction) feeds two questions: do the directions follow pdf()
// (chi-square over cells that adapt to the lobe, absorbed draws counted against 1 - integral of pdf), and is the mean
// of w / pdf the total (Dirac lobes included).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "optics/models.h"
#include "spectral/state.h"

namespace suite::test {

struct ConformanceOptions {
  uint64_t samples = 100000;
  // A run whose first samples leave all three questions with p-values above `doubt` ends there. What all samples refuse
  // is seldom that far from refusal: a lobe 2 % too wide (noncentrality 60 of 41 degrees) ends there in 4 of 1000 runs.
  uint64_t first_samples = 40000;
  double doubt = 0.1;
  uint64_t pilot = 6000;          // samples that shape the cells; another stream than the tested ones
  size_t cells = 48;              // about
  double significance = 1e-6;     // of each single test: the caller divides the family-wise one
  double total_tolerance = 1e-3;  // relative, of total() and of the cells' quadrature
  uint64_t seed = 1;
};

struct ConformanceResult {
  double chi_square_p = 1;  // of the directions
  int degrees = 0;
  double lost_z = 0;   // absorbed or invalid draws against 1 - integral of pdf, in standard errors beyond tolerance
  double total_z = 0;  // worst over wavelengths, in standard errors beyond tolerance
  double worst_weight = 0;  // largest w / pdf at the sampling knot's wavelength
  std::string fault;        // empty, or: negative, not finite, sample with pdf 0, wrong side ...
  double least_p() const;   // of the three questions
  bool passes(const ConformanceOptions& options) const;
  std::string text() const;
};

// Samples at `knot`. Which wavelengths are tested against total: all of them, by drawing the knot at random and
// dividing by the mean density of the knots, when knot < 0.
ConformanceResult conform(const ScatterModel& model, const SpectralState& state, Dir out, int knot,
                          const ConformanceOptions& options);

// Largest |f(out, in) - f(in, out)| / (f + f) over `pairs` random pairs of directions on the upper side.
double worst_reciprocity_error(const ScatterModel& model, const SpectralState& state, int pairs, uint64_t seed);

// A state of a few bins with `knots` knots: 0.45, 0.65, 0.85, 1.65 um.
SpectralState test_state(size_t knots);
// Directions that the tests look along: normal, 20, 60, 80, 89.9 deg; the same from below for models that let something
// pass, one from below for the others.
std::vector<Dir> test_directions(const ScatterModel& model);

}  // namespace suite::test
