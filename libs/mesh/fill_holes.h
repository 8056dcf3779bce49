// Small holes of a surface closed, by CGAL.
#pragma once
#include "scene/draft.h"

namespace suite {

struct FilledHoles {
  size_t holes = 0, triangles = 0;  // closed, and with how many triangles
  size_t left = 0;                  // open edges with more sides, or that cannot be closed
};

// Closes every hole of at most `most_edges` edges with triangles between its corners: those of smallest dihedral angles
// and area (P. Liepa, "Filling holes in meshes", 2003). They are flat, and have
// group, material and texture coordinates of what lies beside them. Welds and drops triangles without area first.
// Extents must be below 1e70.
FilledHoles fill_holes(SourceMesh& mesh, size_t most_edges);

}  // namespace suite
