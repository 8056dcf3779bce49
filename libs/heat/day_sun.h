// Direct sun through a day on any place: what elements are cut by.
#pragma once
#include "heat/elements.h"
#include "motion/time_span.h"

namespace suite {

// At up to `most` times of the span (s) with the sun up, evenly: the beam of a clear sky on the front of a place where
// nothing hides the middle of the sun, W/m2. It does not ask the weather, so that the same elements are found for
// another. towards: to the sun, scene ENU. Keeps a reference to the tracer.
// Source of the beam: A. B. Meinel, M. P. Meinel, Applied Solar Energy, 1976: 1353 W/m2 x 0.7^(air mass^0.678).
DaySun day_sun(const Tracer& tracer, TimeSpan span, const std::function<Dir(double t)>& towards, size_t most = 16);

}  // namespace suite
