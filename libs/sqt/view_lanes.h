// The lobe maps of all views, eight at a time. Internal to libs/sqt.
#pragma once
#include <array>
#include <vector>

#include "sqt/aligned.h"
#include "sqt/vectors.h"

namespace suite::sqt {

// A direction of the divided sphere, in single precision.
using Center = std::array<float, 3>;

// Directions of the views as the lobe map takes them, for eight at a time; filled up with zeros.
struct ViewLanes {
  explicit ViewLanes(const AlignedLayout& layout);
  bool reflects;
  size_t views;
  std::vector<float> x, y, z, weight;  // weight: sin(theta) + 0.05
  // Stretch and cosine (lobe_map.h) of eight views at a point of the divided sphere.
  void at(size_t first, const Center& d, EightFloats& stretch, EightFloats& cosine) const {
    const EightFloats vx = load<EightFloats>(&x[first]), vy = load<EightFloats>(&y[first]),
                      vz = load<EightFloats>(&z[first]);
    const EightFloats along = d[0] * vx + d[1] * vy + d[2] * vz;
    stretch = reflects ? 4 * (along < 0 ? -along : along) : EightFloats{} + 1;
    const EightFloats front = d[2] > 0 ? along : along > 0 ? along : EightFloats{};
    cosine = reflects ? (2 * d[2]) * front - vz : EightFloats{} + d[2];
  }
};

}  // namespace suite::sqt
