// The hierarchy of placements as a flat list of objects, transforms composed in double.
#pragma once
#include <vector>

#include "trace/tracer.h"

namespace suite {

// Depth-first in the order of the groups. Error when the hierarchy unfolds into more than `limit` objects.
std::vector<TracedObject> flatten(const Scene& scene, size_t limit = size_t{1} << 28);

// Bounds in the mesh's local frame (origin included).
Box3 local_bounds(const Mesh& mesh);
// Bounds of a transformed box.
Box3 transformed(const Box3& box, const Affine3& map);

}  // namespace suite
