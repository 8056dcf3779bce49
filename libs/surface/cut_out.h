// Cut-outs: surfaces whose material has an opacity map, through whose holes rays pass (leaves, fences, gratings).
#pragma once
#include <memory>

#include "trace/hit_filter.h"

namespace suite {

// The filter of a scene; null when no material has an opacity map. Where the opacity is between 0 and 1 the surface is
// there for that share of rays: a hash of the ray (origin, direction, time, draw), the flattened instance and the side
// or triangle decides, so the answer does not depend on the order in which surfaces are met. Outside a map that does
// not extend the surface is whole. Keeps a reference to the scene.
std::shared_ptr<const HitFilter> cut_out(const Scene& scene);

}  // namespace suite
