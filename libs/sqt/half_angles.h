// The angles that isotropic surfaces depend on: those of the half vector and of the incident direction about it.
// Based on: S. Rusinkiewicz, "A new change of variables for efficient BRDF representation", EGWR 1998.
#pragma once
#include <cmath>

#include "math/vec.h"

namespace suite::sqt {

// rad. theta_h: of the half vector h from the normal, [0, pi/2]. theta_d: of `in` from h, [0, pi/2]. phi_d: azimuth of
// `in` about h, [-pi, pi], from the direction in which theta_h grows towards n x h. Where h is the normal, phi_d is the
// azimuth of `in`. Straight back it is 0: the plane through the normal, as ScatteringPlane takes it (math/mueller.h).
struct HalfAngles {
  double theta_h = 0, theta_d = 0, phi_d = 0;
  // Both directions above the surface.
  static HalfAngles of(Dir out, Dir in) {
    const Vec3 h = normalized(out + in);
    const double s = std::hypot(h.x, h.y);
    const Vec3 b = s > 1e-12 ? Vec3{-h.y / s, h.x / s, 0} : Vec3{0, 1, 0}, t = cross(b, h);
    const bool apart = length(cross(in, out)) > 1e-14;  // else rounding would choose the plane
    return {std::atan2(s, h.z), std::atan2(length(cross(h, in)), dot(h, in)),
            apart ? std::atan2(dot(b, in), dot(t, in)) : 0};
  }
  // (out, in) with h at azimuth 0; either may lie below the horizon.
  void directions(Dir& out, Dir& in) const {
    const double ch = std::cos(theta_h), sh = std::sin(theta_h), cd = std::cos(theta_d), sd = std::sin(theta_d);
    const Vec3 h{sh, 0, ch}, b{0, 1, 0}, t = cross(b, h);
    in = h * cd + (t * std::cos(phi_d) + b * std::sin(phi_d)) * sd;
    out = h * (2 * dot(h, in)) - in;
  }
};

}  // namespace suite::sqt
