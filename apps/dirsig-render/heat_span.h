// Which time temperatures from weather are found for.
#pragma once
#include "formats/sim_text/sim_text.h"

namespace suite {

// As the simulation's `heat` says, else the day of the sun around all captures, in whole minutes, so that the same day
// is the same span; s of the simulation. Error, located: captures that the span does not cover, or that take more than
// a day.
TimeSpan span_of(const Simulation& sim, double longitude_deg);

}  // namespace suite
