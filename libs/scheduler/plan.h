// How many paths each problem gets, decided without bias.
#pragma once
#include <vector>

#include "radiometry/pipeline.h"

namespace suite {

// Stage 1 of two: the pilot has been run for all problems. The number of paths of a problem comes from the variance of
// its neighbours' pilots, never from its own, so keeping all its samples does not bias its mean. Captures without
// neighbours (a single row and column) get the maximum. Counts are whole multiples of the number of scrambles where the
// limits allow.
std::vector<uint32_t> plan_paths(const Capture& capture, const Accumulators& pilot, size_t reference_band);

}  // namespace suite
