// The way of a ray into the box of an instance or of a shared group, in double. Internal.
#pragma once
#include <immintrin.h>

#include <cmath>

#include "trace/embree_internal.h"

namespace suite {

// From a frame's vectors to those of a thing placed in it, whose floats have their zero at `base`.
struct Inward {
  Vec3 base;
  const double* a;  // row-major
  Vec3 vector(Vec3 v) const {
    return {a[0] * v.x + a[1] * v.y + a[2] * v.z, a[3] * v.x + a[4] * v.y + a[5] * v.z,
            a[6] * v.x + a[7] * v.y + a[8] * v.z};
  }
};

// The same from PlacedSet::Inverse, a column in a register.
struct RestingInward {
  Vec3 base;
  __m256d column[3];
  explicit RestingInward(const PlacedSet::Inverse& inverse) : base(inverse.base) {
    for (int k = 0; k < 3; ++k) column[k] = _mm256_cvtps_pd(_mm_loadu_ps(inverse.linear + 3 * k));
  }
  Vec3 vector(Vec3 v) const {
    const auto times = [&](int k, double x) { return _mm256_mul_pd(column[k], _mm256_set1_pd(x)); };
    alignas(32) double r[4];
    _mm256_store_pd(r, _mm256_add_pd(_mm256_add_pd(times(0, v.x), times(1, v.y)), times(2, v.z)));
    return {r[0], r[1], r[2]};
  }
};

// A ray as an instance sees it, from the point of the ray next to the instance, so that what float did to the matrix
// counts only over its size.
struct SeenRay {
  double closest;  // where that point is, along the ray outside
  Vec3 origin, direction;
  template <class Into>
  SeenRay(const Into& inward, const Ray& ray) {
    const Vec3 away = ray.origin - inward.base;
    closest = -dot(away, ray.direction);
    origin = inward.vector(away + ray.direction * closest), direction = inward.vector(ray.direction);
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
template <class Into>
bool go_in(const Into& inward, const Box3& box, const Ray& ray, double near, double far, LocalRay& out) {
  const auto [closest, o, d] = SeenRay(inward, ray);
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

// Eight at once.
inline void load(const std::array<LocalRay, kWidth>& rays, RTCRay8& q, int* valid) {
  for (unsigned k = 0; k < kWidth; ++k) {
    RTCRay one;
    load(rays[k], one);
    valid[k] = -1;
    q.org_x[k] = one.org_x, q.org_y[k] = one.org_y, q.org_z[k] = one.org_z;
    q.dir_x[k] = one.dir_x, q.dir_y[k] = one.dir_y, q.dir_z[k] = one.dir_z;
    q.tnear[k] = one.tnear, q.tfar[k] = one.tfar, q.time[k] = one.time;
    q.mask[k] = one.mask, q.id[k] = one.id, q.flags[k] = one.flags;
  }
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
