// How the texture coordinates of a surface run over it.
#pragma once
#include "trace/tracer.h"

namespace suite {

// Change of position per unit of u and of v, m, ENU; neither unit nor orthogonal.
struct SurfaceTangents {
  Vec3 dpdu, dpdv;
};

// Texture coordinates at a hit: interpolated over the triangle, or the exact surface's own; barycentrics where the mesh
// has none.
Vec2 uv_at(const Scene& scene, const TracedObject& object, uint32_t triangle, double u, double v);

// Exact for exact surfaces, constant over a triangle with texture coordinates. Where there are none, or where they do
// not span the surface (a pole, a triangle without area in the texture), the directions in which the object's local x
// axis (y where x stands upright on the surface) and its companion run along the surface, of unit length.
SurfaceTangents tangents_at(const Scene& scene, const Affine3& to_world, const TracedObject& object, const Hit& hit);

}  // namespace suite
