// Vertex normals where a file has none: a vertex is split where its facets are to keep an edge between them.
#pragma once
#include <vector>

#include "scene/draft.h"

namespace suite {

struct VertexNormals {
  std::vector<uint32_t> indices;  // three per triangle, into the vertices below
  std::vector<uint32_t> from;     // of each vertex: the vertex of the source it is a copy of
  std::vector<Dir> normals;       // of each vertex, unit, in the frame of the source
};

// everywhere: all corners are smoothed together with all corners at their place; else corners keep the normal they
// have, those without one are smoothed with their smoothing group and are flat where there is none. crease_rad (0 to
// pi): corners at one place are smoothed over an edge only when the facets beside it bend by no more; at pi it makes no
// difference whether they share an edge. Facets without area add nothing; a corner that only such facets meet gets (0,
// 0, 1). A vertex's normal is the mean of its facets' weighted by their angle there, which does not depend on how a
// flat face is cut. Based on: G. Thuermer & C. Wuethrich, "Computing vertex normals from polygonal facets", J. Graphics
// Tools 3(1), 1998.
VertexNormals vertex_normals(const SourceMesh& mesh, bool everywhere, double crease_rad);

}  // namespace suite
