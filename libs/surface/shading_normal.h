// The normal that light is reckoned with: of vertices, and bent by bump and normal maps.
#pragma once
#include "surface/map_lookup.h"
#include "surface/tangents.h"

namespace suite {

// Interpolated vertex normal, on the front side as the winding says; nothing when the mesh has none.
std::optional<Dir> vertex_normal(const Scene& scene, const Affine3& to_world, const TracedObject& object,
                                 const Hit& hit);

// n bent by the heights of a map: n - (gradient of the height along the surface). Based on: J. Blinn, "Simulation of
// wrinkled surfaces", SIGGRAPH 1978, in the form of M. Mikkelsen, "Bump mapping unparametrized surfaces", 2010.
Dir bumped(Dir n, const PropertyMap& map, const MapPlace& place, const SurfaceTangents& tangents);

// The normal that a map gives in the tangent frame of n: x along u (a drape: east), y along v (north), z along n.
// Normals that point into the surface are bent to just above it.
Dir mapped_normal(Dir n, const PropertyMap& map, const MapPlace& place, const SurfaceTangents& tangents);

// n turned as little as needed for a viewer in direction `out` on the side of the true normal to see its front: what
// turns away would be a black edge.
Dir kept_in_view(Dir n, Dir out, Dir true_normal);

}  // namespace suite
