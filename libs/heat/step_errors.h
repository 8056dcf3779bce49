// How far the length of steps may have led temperatures astray.
#pragma once
#include "heat/path_errors.h"

namespace suite {

struct StepErrorOptions {
  size_t sample = 1024;  // elements of a material that are solved again, evenly along their order; others are told the
                         // error of the sampled one before them
  double tolerance = 1e-3;  // K, of the past
};

// Error by the steps, K, root of the mean square over each part of the span, [face][part].
// Method: the same elements, receiving the infrared that was found, through steps twice and four times as long. What
// halving changes less each time gives the order of convergence of each element, kept between a half (a load that
// jumps) and two (the scheme), and that the rest of the series (L. F. Richardson, Phil. Trans. R. Soc. A 210, 1911).
// Longer steps have the loads' means by the hats of straight lines. Assumes: what lies in between moments is as the
// loads say; a span that does not repeat is followed as if it did. At least kHeatParts moments; fewer than nine, or
// elements without heat capacity, which have no steps: 0. Where steps of four times the length find no temperatures the
// order counts as a half; where those of twice the length find none, the error is not known: infinite.
std::vector<float> step_errors(const SolvedSurfaces& solved, const StepErrorOptions& options = {});

}  // namespace suite
