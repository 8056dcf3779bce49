// A place that asks for light.
#pragma once
#include "math/vec.h"

namespace suite {

// normal: on the side from which it looks; null vector = takes light from everywhere. two_sided: takes light from
// behind as well.
struct LightReceiver {
  Vec3 position;  // m, ENU
  Vec3 normal;
  bool two_sided = false;
};

}  // namespace suite
