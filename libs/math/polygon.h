// Splitting of planar polygons into triangles.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

// Corner triples (indices into `corners`) that cover the polygon, same orientation; n - 2 of them for n corners. clean:
// false when no ear was found at some step (self-crossing, or all corners on a line), or the search would take long
// (many thousand corners, most of them reflex), and a plain fan finished the job. Based on: G. Meisters, "Polygons have
// ears", 1975; normal after M. Newell (Sutherland et al. 1974).
std::vector<std::array<int, 3>> split_polygon(std::span<const Vec3> corners, bool& clean);

}  // namespace suite
