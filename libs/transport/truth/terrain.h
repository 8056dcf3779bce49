// How open the ground is: what corrections of images for the air take from a scene beside its air. Internal to truth.
#pragma once
#include <vector>

#include "transport/truth/truth.h"

namespace suite {

// slope, aspect, sky_view.
void add_terrain_rows(std::vector<TruthRow>& table);

}  // namespace suite
