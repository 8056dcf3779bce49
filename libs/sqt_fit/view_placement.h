// Where the slices of the aligned method go: view angles dense where the function, seen in lobe coordinates, bends.
//
// Linear interpolation errs by h^2 |f''| / 8; the mean error is least when the nodes equidistribute cbrt(|f''|), and
// their number follows from the error allowed. Based on: de Boor, "Good approximation by splines with variable knots",
// 1973.
#pragma once
#include <vector>

#include "sqt/function.h"
#include "sqt/lobe_map.h"

namespace suite::sqt {

// Ascending polar angles from 0 to `last`, rad. count = 0: as many as an interpolation error of `allowed` (mean over
// directions, log2 units, weighed by their share of the scattered power) asks for, between 9 and `most`.
std::vector<double> place_views(const Function& function, LobeFrame frame, size_t count, size_t most, double last,
                                double allowed);

}  // namespace suite::sqt
