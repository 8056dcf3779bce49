// The fixed grid of scattering angles on which particles keep their phase functions, and what integrals over it are.
//
// 397 angles, from 0.017 degrees apart in the diffraction peak to 0.8 degrees aside. Between them a phase function is
// linear in the cosine: every integral below is exact for that function, which is the one that phases/cosine_table.h
// samples, so that moments and samples agree.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "math/mueller.h"

namespace suite {

// Cosines, ascending from -1 to 1.
std::span<const double> phase_cosines();
// Where a cosine lies between two of them: at a share of the way from `below` to the next one.
struct PhasePlace {
  size_t below;
  double share;  // 0..1
};
PhasePlace phase_place(double cosine);
// Integral over the sphere of values (1/sr) given there.
double phase_integral(std::span<const double> values);
// Legendre moments, integral of P_l p over the sphere, l = 0 .. count-1; moment 1 is the asymmetry.
std::vector<double> legendre_moments(std::span<const float> values, size_t count);

// Tables keep every third angle; these are theirs, cosines ascending, and how the rest follows: the logarithm of the
// phase function by cubics whose slopes are those of parabolas through three neighbours, then scaled to 1 over the
// sphere.
std::span<const double> stored_cosines();
std::vector<double> refined_phase(std::span<const double> log_values);
// The cubics alone, of any values.
std::vector<double> refined(std::span<const double> values);
// The same of the elements of scattering matrices of spheres over their first one, none beyond what exists.
std::vector<PlaneBlocks> refined_matrices(std::span<const PlaneBlocks> over_first);

}  // namespace suite
