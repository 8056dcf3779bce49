// Sample allocation: how many paths each problem gets, decided without bias.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "estimate/accumulators.h"
#include "estimate/budget.h"

namespace suite {

// A band whose error decides. weight: (least target / its target)^2, so that one number tells what a problem needs.
struct JudgedBand {
  size_t band = 0;
  double weight = 1;
  std::optional<BandNoise> noise = {};  // what the error is judged beside; none: radiance
  // Where the error is that of the degree of linear polarisation, absolute: the numbers of the band's Q and U among a
  // problem's values. It is taken as that of the degree times the radiance, beside radiance.
  struct Degree {
    size_t q = 0, u = 0;
    double target = 0;
  };
  std::optional<Degree> degree = {};
  // The square of that, for a problem's radiance and its goal's floor.
  double square_scale(double radiance, double floor) const;
};

// Stage 1 of two: the pilot has been run for all problems. What a problem needs follows from the variance of its
// neighbours' pilots, never from its own, so keeping all its samples does not bias its mean: the number of paths that
// would bring the relative standard error to 1, variance / max(mean, floor)^2, pooled over the 24 problems around it
// (beside a detector's noise: variance / its variance);
// the largest over the bands in `judged`, each times its weight. The count for another target is this divided by the
// target squared, so that a run which is continued plans from the same pilot. 0 where no variance was seen; infinite
// where the mean is 0. A problem's floor is its own goal's. The variance of a degree of polarisation is the larger of
// two: about the degree of all neighbours together, and the mean of those about their own (jackknife); times 1 + the
// square of that mean's relative standard error, which a few bright paths make large.
std::vector<double> needs_of(const Capture& capture, const Accumulators& pilot, std::span<const JudgedBand> judged,
                             const Goals& goals);

// The same from each problem's own pilot, for captures without neighbours (a single problem): unbiased only when the
// pilot is thrown away.
std::vector<double> own_needs_of(const Accumulators& pilot, std::span<const JudgedBand> judged, const Goals& goals);
bool has_neighbours(const Capture& capture);

// Paths of every problem for its target: whole multiples of four (the scrambles) within its limits; its maximum without
// a target.
std::vector<uint32_t> paths_for(std::span<const double> needs, const Goals& goals);

// The largest maximum of paths, at least goals.all.min_paths, under which paths_for sums to at most `total`.
uint32_t cap_for_total(std::span<const double> needs, const Goals& goals, double total);

}  // namespace suite
