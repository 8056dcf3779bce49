// Which side of a surface is bounded: a closed surface parts a bounded side from all the rest of space.
#pragma once
#include "scene/scene.h"

namespace suite {

enum class BoundedSide : uint8_t {
  none,    // neither: it is open, or has no bounds itself
  behind,  // closed, front sides out
  front    // closed, front sides in
};

BoundedSide bounded_side(const Primitive& primitive);
// By Gauss' theorem over all of its triangles, to rounding: of a closed surface the integral of the normal is 0, that
// of place times normal is volume times unity. The arrays must be here.
BoundedSide bounded_side(const Mesh& mesh);

}  // namespace suite
