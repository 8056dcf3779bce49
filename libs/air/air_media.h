// Layers of air as ordinary media, for paths that are scattered in them.
#pragma once
#include <memory>
#include <vector>

#include "air/column.h"
#include "optics/medium.h"

namespace suite {

// One medium a layer, of density 1; it emits as the mean of its ends. The column is shared by their phase functions.
std::vector<BakedMedium> air_media(const std::shared_ptr<const AirColumn>& column, const SpectralState& state);

}  // namespace suite
