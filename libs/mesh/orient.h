// Triangles made to agree with their neighbours, by CGAL. Internal to the library.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

// corners: three welded positions a triangle, no two of one triangle the same. A closed piece is to face outwards, but
// one that lies inside of another piece (a cavity, or a body in a body) and an open one go by their majority. Pieces
// that cannot be made consistent (a Moebius strip) stay as they are. Of more than 2000 closed pieces none counts as
// inside of another. True for the triangles that are to be turned.
std::vector<bool> to_be_turned(std::span<const Vec3> positions, std::span<const uint32_t> corners);

// The same triangles as a manifold: see OrientedSurface in surface.h.
struct Manifold {
  std::vector<uint32_t> corners;  // three vertices a triangle, in the order that agrees with the neighbours
  std::vector<uint32_t> from;     // of each vertex: its welded position
  std::vector<bool> turned;       // of each triangle: its order is not the one given
};
Manifold manifold(std::span<const Vec3> positions, std::span<const uint32_t> corners);

}  // namespace suite
