// How the normal that light is reckoned with turns along a surface: its curvature, as ray differentials need it.
//
// Exact surfaces and normals of vertices: from their equations. Bump and normal maps: central differences of
// Surface::interact at hits beside, in the same triangle (extrapolated at its edges), so that the float steps of
// barycentrics cancel. Based on: H. Igehy, "Tracing ray differentials", SIGGRAPH 1999 (derivatives of interpolated
// normals).
#pragma once
#include "surface/surface.h"

namespace suite {

struct NormalTurn {
  Dir tangent[2] = {};  // independent, along the surface
  Vec3 per_m[2] = {};   // change of the unit normal along each, 1/m
  // Change of the unit normal over a small step along the surface, m.
  Vec3 over(Vec3 step) const;
};

// At a hit seen from `out`; at: what Surface::interact has made of it (material with maps that bend the normal, but do
// not vary otherwise); beside: working memory. Zero on flat faces.
NormalTurn normal_turn(const Surface& surface, const Hit& hit, Dir out, const Interaction& at, Interaction& beside);

}  // namespace suite
