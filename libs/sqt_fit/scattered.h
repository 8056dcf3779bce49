// Scattered measurements as a function that can be asked anywhere: planes through the nearest samples, the near ones
// counting most, in coordinates in which lobes stand still.
//
// Coordinates of a pair: half vector (x, y) in the plane of the view (bilateral samples stand at y and -y), view polar
// angle (and azimuth as a vector when anisotropic); for phase functions and intensities the direction itself. Sides are
// kept apart, and so are the views of isotropic data that have 24 places or more each, as tables of instruments and
// goniometers do: between two views values change linearly with the view's angle. Between samples the values lie
// between those of the samples around: never negative where these are not, never larger. Far from all samples the
// nearest ones hold.
//
// Based on: Shepard, "A two-dimensional interpolation function for irregularly-spaced data", ACM 1968, in the local
// form of Franke & Nielson (1980), with nodal planes (as theirs, fitted around the place that is asked); k-d tree:
// Bentley, CACM 18, 1975.
#pragma once
#include <array>
#include <memory>

#include "sqt_fit/samples.h"

namespace suite::sqt {

// Samples with NaN in a channel do not count. A sample repeated with different values counts with their mean.
// Errors: no valid sample; lengths that do not fit.
std::shared_ptr<const Function> interpolate(const Samples& samples);

}  // namespace suite::sqt
