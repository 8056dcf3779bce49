// The transform of a placement: scale, rotate, translate or a matrix; see FORMAT.md.
#pragma once
#include <optional>

#include "base/params.h"
#include "math/vec.h"

namespace suite {

// From the keys of a map; nothing when it has none of them. Error, located.
std::optional<Affine3> find_transform(const Params& p);

}  // namespace suite
