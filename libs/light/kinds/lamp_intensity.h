// Where points and spots send their light, and when. Internal to lamps.
#pragma once
#include "light/kinds/lamps.h"

namespace suite {

// Relative intensity of a point lamp into a direction of its frame.
double relative_intensity(const LampSpec& lamp, Dir local);

// The profile of a point lamp: means over 32 azimuths and 9 places within each step, its edges included. A table may
// have light between these, so none of its steps counts as dark.
LightProfile profile_of(const LampSpec& lamp);

// What the lamp's schedule multiplies its light with at a time (s), and the most that it does in a window, or ever.
double dimming(const LampSpec& lamp, double time);
double brightest(const LampSpec& lamp, std::optional<TimeSpan> window);

}  // namespace suite
