// Where a ray meets an exact surface, in the surface's local frame, in double.
// Based on: the usual quadric solutions with the cancellation-free root of Press et al., "Numerical Recipes", 5.6; the
// height field by subdivision with bounds on the function and its slope (Kalra & Barr, SIGGRAPH 1989).
#pragma once
#include <optional>

#include "scene/scene.h"

namespace suite {

struct LocalHit {
  double t;     // in units of the direction's length
  Vec3 normal;  // outward or upward, any length
  double u, v;  // as libs/scene/primitives.h says for each kind
};

// First hit with t_min < t < t_max. direction: any length > 0. The primitive has passed check_primitive.
std::optional<LocalHit> intersect(const Primitive& primitive, Vec3 origin, Vec3 direction, double t_min, double t_max);
// The same hit's t, which takes less; infinity when there is none.
double distance_to(const Primitive& primitive, Vec3 origin, Vec3 direction, double t_min, double t_max);

}  // namespace suite
