// Fewer triangles for the same shape, by OpenMesh.
#pragma once
#include "scene/draft.h"

namespace suite {

struct Decimated {
  size_t before = 0, after = 0;  // triangles that have an area
  double distance = 0;   // farthest that the old surface is from the new one, mesh units, looked for at corners,
                         // middles of edges and centres of triangles
  bool refused = false;  // thousands of triangles meet in one vertex: the mesh is as it was
};

// Takes vertices away, those first that change the shape least, until `to` (0 to 1) of the triangles are left or
// nothing can go that leaves `distance` at most `error` (mesh units, infinite: any). What stays keeps its place,
// normal, texture coordinates, material and group. Open edges and borders between any of these move by no more than
// `error` (a 200th of the mesh's diagonal where it is infinite), texture along them by no more than a hundredth of
// the picture in one step; where borders meet nothing moves. Welds and drops triangles without area first. Extents must
// be below 1e70. Based on: M. Garland & P. Heckbert, "Surface simplification using quadric error metrics", 1997, as in
// OpenMesh.
Decimated decimate_mesh(SourceMesh& mesh, double to, double error);

// Internal to the library: the distance above, between triangles given by their corners.
double farthest(std::span<const Vec3> positions, std::span<const uint32_t> from, std::span<const uint32_t> to);

}  // namespace suite
