// Geometry as a picture needs it: few triangles, whatever there were, and exact surfaces as triangles.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace suite {

struct Sketch {
  std::vector<float> positions;  // 3 a vertex, local, relative to `origin`
  Vec3 origin;
  std::vector<uint32_t> indices;   // 3 a triangle, ordered by material
  std::vector<uint32_t> material;  // of each triangle; ascending
  size_t before = 0;               // triangles that there were
  double moved = 0;                // m, local: how far a corner is from where it was, at most
  bool thinned = false;            // some triangles are left alone, larger than they were, in place of all
};

// At most `most` (>= 12) triangles of a mesh, whose arrays must be here. Corners within a cell of a grid become one,
// their mean; the grid is as fine as the number allows. Where that would take most of the surface away (leaves smaller
// than cells), every n-th triangle is kept instead, so much larger that the area stays. Based on: J. Rossignac & P.
// Borrel, "Multi-resolution 3D approximations for rendering complex scenes", 1993; R. L. Cook, J. Halstead, M. Planck &
// D. Ryu, "Stochastic simplification of aggregate detail", 2007.
Sketch sketch_of(const Mesh& mesh, size_t most);

// Triangles of an exact surface, `around` (>= 6) of them around what is round. reach: half the edge of what has no end,
// m.
Sketch sketch_of(const Primitive& primitive, double reach, int around = 48);

}  // namespace suite
