// Equiangular distances: places on a ray that a lamp sees at even angles, so that the 1 / d2 of its light cancels.
// Based on: C. Kulla & M. Fajardo, "Importance sampling techniques for path tracing in participating media", EGSR 2012,
// section 4.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "math/vec.h"

namespace suite {

// Point lamps of a scene for which flights look for such places; each flight looks at all of them.
inline constexpr size_t kMostEquiangularLamps = 16;

class EquiangularLaw {
 public:
  EquiangularLaw() = default;
  // Of a ray's first `length` m (> 0; may be infinite) and a point. Without a use where the ray runs through the point.
  EquiangularLaw(Vec3 origin, Dir direction, double length, Vec3 point) {
    const Vec3 to = point - origin;
    along_ = dot(to, direction);
    beside_ = suite::length(to - direction * along_);
    if (!(beside_ > kNearest * std::fabs(along_))) return;
    begin_ = std::atan2(-along_, beside_);
    const double end =
        length < std::numeric_limits<double>::infinity() ? std::atan2(length - along_, beside_) : kPi / 2;
    angle_ = std::max(0.0, end - begin_);
  }
  // What the lamp's light on the ray would come to without anything on its way: the angle over the distance.
  double worth() const { return angle_ > 0 ? angle_ / beside_ : 0; }
  // m from the origin; u: in [0, 1).
  double draw(double u) const { return along_ + beside_ * std::tan(begin_ + u * angle_); }
  double density(double t) const {  // 1/m
    const double off = t - along_;
    return angle_ > 0 ? beside_ / (angle_ * (beside_ * beside_ + off * off)) : 0;
  }

 private:
  static constexpr double kNearest = 1e-9;
  double along_ = 0, beside_ = 0;  // m, of the point
  double begin_ = 0, angle_ = 0;   // rad, as the point sees the ray
};

}  // namespace suite
