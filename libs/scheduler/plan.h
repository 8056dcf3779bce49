// How many paths each problem gets, decided without bias.
#pragma once
#include <span>
#include <vector>

#include "radiometry/pipeline.h"

namespace suite {

// Stage 1 of two: the pilot has been run for all problems. What a problem needs follows from the variance of its
// neighbours' pilots, never from its own, so keeping all its samples does not bias its mean: the number of paths that
// would bring the relative standard error to 1, variance / max(mean, floor)^2, pooled over the 24 problems around it;
// the largest over the bands in `judged`. The count for another target is this divided by the target squared, so that a
// run which is continued plans from the same pilot. 0 where no variance was seen; infinite where the mean is 0.
std::vector<double> needs_of(const Capture& capture, const Accumulators& pilot, std::span<const size_t> judged,
                             double absolute_floor);

// The same from each problem's own pilot, for captures without neighbours (a single problem): unbiased only when the
// pilot is thrown away.
std::vector<double> own_needs_of(const Accumulators& pilot, std::span<const size_t> judged, double absolute_floor);
bool has_neighbours(const Capture& capture);

// Paths of every problem for a target: whole multiples of four (the scrambles) within the limits.
std::vector<uint32_t> paths_for(std::span<const double> needs, const Convergence& goal);

// The largest maximum of paths, at least goal.min_paths, under which paths_for sums to at most `total`.
uint32_t cap_for_total(std::span<const double> needs, const Convergence& goal, double total);

}  // namespace suite
