// Whether a scene's origin can be meant: a terrain that is placed by its own coordinates tells where on the Earth the
// scene is.
#pragma once
#include <optional>
#include <string>

#include "scene/bake.h"
#include "scene/scene.h"

namespace suite {

// What is wrong with an origin that lies more than two degrees aside of a georeferenced terrain, with the terrain's
// extent, and the exchange of numbers that would bring it there if there is one. terrain: in ENU around the origin.
std::optional<std::string> misplaced_origin(const TerrainGrid& terrain, const GeodeticOrigin& origin);

}  // namespace suite
