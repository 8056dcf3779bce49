// Triangles in planes, by CGAL's Delaunay triangulations: polygons with holes, and surfaces over scattered points.
#pragma once
#include "base/report.h"
#include "scene/draft.h"

namespace suite {

// Cuts mesh.holed into triangles behind the others, with the orientation of their outer rings, and empties it. Rings
// may touch. Where rings cross, lie outside, or areas do not add up to 1e-6, SP206 is filed, and the outer ring is
// closed instead. Flat polygons are expected: corners are projected along the normal of the outer ring (Newell). Based
// on: L. P. Chew, "Constrained Delaunay triangulations", Algorithmica 4, 1989, as in CGAL.
void cut_holed(SourceMesh& mesh, Report& report);

struct Tin {
  size_t points = 0, used = 0;  // used: corners of triangles
  double error = 0;             // largest |difference of height| of a point that is not used, mesh units
};
// Puts triangles, front sides up, through points of which it keeps as few as leave every point within `error` in height
// (0: all that differ in x or y), the one that is farthest off added first; of points at one x, y the first holds.
// Corners of the convex hull stay. longest: triangles with a longer edge in plan are left out; 0: none are. Points must
// be finite. Based on: M. Garland & P. Heckbert, "Fast polygonal approximation of terrains and height fields",
// CMU-CS-95-181, 1995 (algorithm III), with CGAL's Delaunay triangulation.
Tin make_tin(SourceMesh& mesh, double error, double longest);

}  // namespace suite
