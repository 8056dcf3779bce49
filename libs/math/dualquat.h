// Unit quaternions and unit dual quaternions: rigid poses, and screw interpolation (ScLERP) between them.
// Based on: L. Kavan, S. Collins, C. O'Sullivan, J. Zara, "Dual quaternions for rigid transformation blending", 2006.
#pragma once
#include "math/vec.h"

namespace suite {

struct Quat {
  double w = 1, x = 0, y = 0, z = 0;
  Quat operator*(const Quat& b) const {
    return {w * b.w - x * b.x - y * b.y - z * b.z, w * b.x + x * b.w + y * b.z - z * b.y,
            w * b.y - x * b.z + y * b.w + z * b.x, w * b.z + x * b.y - y * b.x + z * b.w};
  }
  Quat operator+(const Quat& b) const { return {w + b.w, x + b.x, y + b.y, z + b.z}; }
  Quat operator*(double s) const { return {w * s, x * s, y * s, z * s}; }
  Quat conjugate() const { return {w, -x, -y, -z}; }
  Vec3 vec() const { return {x, y, z}; }
};
inline double dot(const Quat& a, const Quat& b) { return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z; }
Quat normalized(const Quat& q);  // Bug when the norm is 0 or not finite
Quat quat_about(Dir axis, double angle);
Quat quat_from_matrix(const Affine3& rotation);  // Shepperd's method; `rotation` must be a proper rotation
Vec3 rotate(const Quat& q, Vec3 v);

// Rigid motion p -> R p + t.
struct Pose {
  Quat rotation;
  Vec3 translation;
  Vec3 point(Vec3 p) const { return rotate(rotation, p) + translation; }
  Vec3 vector(Vec3 v) const { return rotate(rotation, v); }
  Affine3 affine() const;
  Pose operator*(const Pose& first) const;  // this after first
  Pose inverse() const;
};

// Real part rotates, dual part carries half the translation.
struct DualQuat {
  Quat real, dual{0, 0, 0, 0};
  static DualQuat from(const Pose& pose);
  Pose pose() const;
};

// The screw motion from a (s = 0) to b (s = 1) along the shorter way round; s outside [0, 1] extrapolates the screw.
// Exact for rotations by 0, by less than 1e-9 rad and by 180 degrees. There (within 2e-12 rad) both ways round are
// equally short, and the one whose axis has a positive first component in a's frame is taken: the same in every world
// frame. The screw is taken relative to a, so large common translations (Earth-centred coordinates) cost no precision
// in it.
Pose sclerp(const Pose& a, const Pose& b, double s);

}  // namespace suite
