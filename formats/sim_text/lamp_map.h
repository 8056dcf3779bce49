// Maps of how bright a glowing surface is, from rasters.
#pragma once
#include <memory>

#include "base/params.h"
#include "light/lamp_map.h"

namespace suite {

// Keys `file`, `local` and `no_data`. Located Error: no such file, more than one channel, more than 2^26 pixels, a
// system of coordinates that is not known here, nothing in it that glows. Warns of negative values.
std::shared_ptr<const LampMap> read_lamp_map(const Params& p);

}  // namespace suite
