// What faces absorb of a day's sun and sky, from what paths found of them.
#pragma once
#include "heat/heat_balance.h"

namespace suite {

// W/m2 by face and moment, in the place of what faces take of the beam; what they have in later intervals of rest is
// added, and goes. ground_albedo: beyond the scene. shares: of the moments by interval (interval_shares()).
void absorb(Sunlight& sun, const WeatherLoads& loads, double ground_albedo,
            const std::vector<std::vector<float>>& shares);

}  // namespace suite
