// Repairs that change no surface: done on request only, each one told.
#pragma once
#include "base/report.h"
#include "scene/draft.h"

namespace suite {

struct MeshRepairs {
  size_t welded = 0;   // positions at the place of another one, now shared (normals and UVs equal too)
  size_t dropped = 0;  // triangles without area or repeating another one the same way round
  size_t turned = 0;   // triangles turned so that neighbours agree
};

// The first two of them: what the others and decimation build on.
MeshRepairs tidy_mesh(SourceMesh& mesh);

// Welds, drops degenerate and duplicate triangles and orients the rest; vertex normals of turned triangles are kept as
// they are. Runs and lines stay right. Orientation is left alone when it cannot be made consistent.
MeshRepairs repair_mesh(SourceMesh& mesh);

// Internal to the library: -----------------------------------------------------------------------------------------

// Keeps the triangles marked, with their lines, groups and runs; how many went.
size_t keep_triangles(SourceMesh& mesh, const std::vector<bool>& kept);

}  // namespace suite
