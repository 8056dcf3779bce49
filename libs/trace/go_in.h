// The way of a ray into the box of an instance or of a shared group, in double. Internal.
#pragma once
#include <cmath>

#include "trace/embree_internal.h"

namespace suite {

// From a frame's vectors to those of a thing placed in it, whose floats have their zero at `base`.
template <class T>
struct Inward {
  Vec3 base;
  const T* a;  // row-major
  Vec3 vector(Vec3 v) const {
    return {a[0] * v.x + a[1] * v.y + a[2] * v.z, a[3] * v.x + a[4] * v.y + a[5] * v.z,
            a[6] * v.x + a[7] * v.y + a[8] * v.z};
  }
};

// A ray inside an instance, from the zero of its floats: unit direction, its start where it enters the box.
struct LocalRay {
  Vec3 origin, direction;
  double enter;    // along the ray outside, m of its frame
  double stretch;  // local length of one metre of it
  double reach;    // local
  unsigned id;     // of the float ray outside
};

// The stretch of the ray between near and far that lies in the instance's box; false when there is none.
template <class T>
bool go_in(const Inward<T>& inward, const Box3& box, const Ray& ray, double near, double far, LocalRay& out) {
  // The point of the ray next to the instance, so that what float did to the matrix counts only over its size.
  const Vec3 away = ray.origin - inward.base;
  const double closest = -dot(away, ray.direction);
  const Vec3 o = inward.vector(away + ray.direction * closest), d = inward.vector(ray.direction);
  near -= closest, far -= closest;
  for (int i = 0; i < 3; ++i) {
    const double inverse = 1 / d[i], a = (box.low[i] - o[i]) * inverse, b = (box.high[i] - o[i]) * inverse;
    const double first = a > b ? b : a, last = a > b ? a : b;
    // 0 * infinity is NaN and does not clip; the box is wide enough for rounding.
    if (first > near) near = first;
    if (last < far) far = last;
  }
  if (!(near <= far)) return false;
  out.enter = near + closest;
  out.stretch = length(d);
  out.origin = o + d * near;
  out.direction = d / out.stretch;
  out.reach = (far - near) * out.stretch;
  return true;
}

inline void load(const LocalRay& r, RTCRay& q) {
  q.org_x = static_cast<float>(r.origin.x), q.org_y = static_cast<float>(r.origin.y),
  q.org_z = static_cast<float>(r.origin.z);
  q.dir_x = static_cast<float>(r.direction.x), q.dir_y = static_cast<float>(r.direction.y),
  q.dir_z = static_cast<float>(r.direction.z);
  q.tnear = 0, q.tfar = static_cast<float>(r.reach), q.time = 0, q.mask = 0xffffffffu, q.id = r.id, q.flags = 0;
}

// What ray i of a callback has met at t, to Embree.
inline void hand_out(const RTCIntersectFunctionNArguments* args, unsigned i, double t, float u, float v,
                     unsigned triangle) {
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
  RTCRayN_tfar(RTCRayHitN_RayN(args->rayhit, args->N), args->N, i) = static_cast<float>(t);
  RTCHitN_u(hit, args->N, i) = u;
  RTCHitN_v(hit, args->N, i) = v;
  RTCHitN_primID(hit, args->N, i) = triangle;
  RTCHitN_geomID(hit, args->N, i) = args->geomID;
  RTCHitN_instID(hit, args->N, i, 0) = args->primID;
}

}  // namespace suite
