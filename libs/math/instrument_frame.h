// The frames in which instruments and lamps say how their light is polarised: by an axis of theirs, whatever the
// light's direction. Meridian frames (mueller.h) follow by frame_rotation.
#pragma once
#include "math/mueller.h"

namespace suite {

// e1 as near to a direction x as it can be: the projection of x. Along x, where there is none, that of the meridian.
inline PolarFrame frame_about(Dir k, Vec3 x) {
  const Vec3 across = x - k * dot(x, k);
  if (!(length(across) > 1e-12 * length(x))) return meridian_frame(k);
  const Vec3 e1 = normalized(across);
  return {e1, cross(k, e1)};
}

}  // namespace suite
