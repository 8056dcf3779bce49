// Meshes of loose pieces, leaves above all. Internal.
#pragma once
#include "scene/scene.h"

namespace suite {

// Whether no more edges of a mesh are shared by triangles than belong to one alone. Light passes by such a mesh
// everywhere, and Embree's faster triangles may stand for it: between two of them a ray slips through with a chance of
// some 1e-8 times the size of the mesh over that of a triangle. Edges are those of places: what stores the corners of
// each triangle anew is as closed as it looks. Of large meshes some 2^14 edges are looked at. The arrays must be here.
bool is_loose(const Mesh& mesh);

}  // namespace suite
