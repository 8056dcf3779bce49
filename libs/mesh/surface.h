// A welded mesh as CGAL's half-edge structure. Internal to the library.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include "math/vec.h"

namespace suite {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

// corners: three welded positions a triangle, no two of one triangle the same. Face t of `mesh` is triangle t, turned
// where `turned` says so. Neighbours agree wherever that is possible; where more than two triangles meet at an edge,
// where surfaces touch in a vertex, and where a one-sided surface comes back to itself, vertices are doubled, so that
// the result is a manifold; what was cut apart within one piece is sewn again where it fits.
struct OrientedSurface {
  Surface mesh;
  std::vector<bool> turned;
};
OrientedSurface oriented_surface(std::span<const Vec3> positions, std::span<const uint32_t> corners);

}  // namespace suite
