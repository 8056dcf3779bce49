#include "math/dualquat.h"

#include "base/error.h"

namespace suite {

Quat normalized(const Quat& q) {
  const double n = std::sqrt(dot(q, q));
  SUITE_CHECK(n > 0 && std::isfinite(n));
  return q * (1 / n);
}

Quat quat_about(Dir k, double angle) {
  const double s = std::sin(angle / 2);
  return {std::cos(angle / 2), k.x * s, k.y * s, k.z * s};
}

Quat quat_from_matrix(const Affine3& m) {
  const auto& a = m.a;
  const double trace = a[0] + a[4] + a[8];
  Quat q;
  if (trace >= a[0] && trace >= a[4] && trace >= a[8])
    q = {1 + trace, a[7] - a[5], a[2] - a[6], a[3] - a[1]};
  else if (a[0] >= a[4] && a[0] >= a[8])
    q = {a[7] - a[5], 1 + a[0] - a[4] - a[8], a[1] + a[3], a[2] + a[6]};
  else if (a[4] >= a[8])
    q = {a[2] - a[6], a[1] + a[3], 1 - a[0] + a[4] - a[8], a[5] + a[7]};
  else
    q = {a[3] - a[1], a[2] + a[6], a[5] + a[7], 1 - a[0] - a[4] + a[8]};
  return normalized(q);
}

Vec3 rotate(const Quat& q, Vec3 v) {
  const Vec3 u = q.vec(), t = cross(u, v) * 2.0;
  return v + t * q.w + cross(u, t);
}

Affine3 Pose::affine() const {
  const Vec3 cx = rotate(rotation, {1, 0, 0}), cy = rotate(rotation, {0, 1, 0}), cz = rotate(rotation, {0, 0, 1});
  return {{cx.x, cy.x, cz.x, cx.y, cy.y, cz.y, cx.z, cy.z, cz.z}, translation};
}
Pose Pose::operator*(const Pose& first) const { return {rotation * first.rotation, point(first.translation)}; }
Pose Pose::inverse() const {
  const Quat c = rotation.conjugate();
  return {c, -rotate(c, translation)};
}

DualQuat DualQuat::from(const Pose& p) {
  const Quat t{0, p.translation.x, p.translation.y, p.translation.z};
  return {p.rotation, (t * p.rotation) * 0.5};
}
Pose DualQuat::pose() const {
  const Quat t = (dual * real.conjugate()) * 2.0;
  return {real, t.vec()};
}

namespace {
constexpr double kHalfTurn = 1e-12;  // cosine of half the angle below which both ways round are equally short
}

Pose sclerp(const Pose& a, const Pose& b, double s) {
  // The relative motion in a's own frame: translations are small there, whatever frame the poses are given in.
  Quat q = a.rotation.conjugate() * b.rotation;
  const Vec3 t = rotate(a.rotation.conjugate(), b.translation - a.translation);
  if (std::fabs(q.w) < kHalfTurn) {
    // Half a turn: rounding would choose the way round. The first component of the axis that is not nothing does.
    const Vec3 u = q.vec();
    const double leading = std::fabs(u.x) > 1e-6 ? u.x : std::fabs(u.y) > 1e-6 ? u.y : u.z;
    if (leading < 0) q = q * -1.0;
  } else if (q.w < 0) {
    q = q * -1.0;  // the shorter way round
  }
  const Vec3 u = q.vec();
  const double sin_half = length(u), half = std::atan2(sin_half, q.w);
  Pose step;
  if (sin_half < 1e-100) {
    // No rotation: the screw has infinite pitch, a straight line. Its bend would be of this size times the distance.
    step = {normalized(Quat{1, u.x * s, u.y * s, u.z * s}), t * s};
  } else {
    // Screw axis direction l, pitch along it d, and the foot of the axis c with t = d l + (I - R) c.
    const Vec3 l = u / sin_half;
    const double d = dot(t, l);
    const Vec3 across = t - l * d;
    const Vec3 c = (across + cross(l, across) * (q.w / sin_half)) * 0.5;
    step.rotation = quat_about(l, 2 * half * s);
    // (I - R(s)) c without cancellation for small angles: c is across the axis, so R c = cos c + sin (l x c).
    const double angle = 2 * half * s, h = std::sin(angle / 2);
    step.translation = l * (d * s) + c * (2 * h * h) - cross(l, c) * std::sin(angle);
  }
  return a * step;
}

}  // namespace suite
