// A screw motion in closed form, and how far two poses are apart.
#pragma once
#include <cmath>

#include "math/dualquat.h"

namespace suite::test {

// Rotation by `angle` about the line through `foot` along `axis`, with `advance` metres along it per whole motion.
struct Screw {
  Dir axis;
  Vec3 foot;
  double angle, advance;
  Pose at(double s) const {
    const Quat q = quat_about(axis, s * angle);
    return {q, foot - rotate(q, foot) + axis * (advance * s)};
  }
};

// Largest distance between the images of the corners of a 100 m box.
inline double apart(const Pose& a, const Pose& b) {
  double worst = 0;
  for (const double x : {-50.0, 50.0})
    for (const double y : {-50.0, 50.0})
      for (const double z : {-50.0, 50.0}) worst = std::fmax(worst, length(a.point({x, y, z}) - b.point({x, y, z})));
  return worst;
}

}  // namespace suite::test
