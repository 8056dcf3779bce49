#include "trace/primitive_hit.h"

#include <algorithm>
#include <cmath>

#include "scene/primitives.h"

namespace suite {

namespace {

// Keeps the nearest candidate inside the interval: here its distance,
struct Soonest {
  double t_min, t_max;
  bool wants(double t) const { return t > t_min && t < t_max; }
  template <class Describe>
  void take(double t, const Describe&) {
    t_max = t;
  }
};

// and here what it is like.
struct Nearest : Soonest {
  std::optional<LocalHit> hit;
  template <class Describe>
  void take(double t, const Describe& describe) {
    t_max = t;
    hit = describe();
  }
};

double turns(double y, double x) {
  const double phi = std::atan2(y, x) / (2 * kPi);
  return phi < 0 ? phi + 1 : phi;
}

// Real roots of a t^2 + 2 b t + c, ascending; false when there are none.
bool roots(double a, double b, double c, double t[2]) {
  const double d = b * b - a * c;
  if (!(d >= 0) || a == 0) return false;
  const double q = -(b + std::copysign(std::sqrt(d), b));
  t[0] = q / a;
  t[1] = q != 0 ? c / q : t[0];
  if (t[0] > t[1]) std::swap(t[0], t[1]);
  return true;
}

template <class Found>
void plane(const std::vector<double>& a, Vec3 o, Vec3 d, Found& n) {
  const double t = -o.z / d.z;
  if (d.z == 0 || !n.wants(t)) return;
  const double x = o.x + t * d.x, y = o.y + t * d.y;
  if (a[0] == 0)
    n.take(t, [&] { return LocalHit{t, {0, 0, 1}, x, y}; });
  else if (std::fabs(x) <= a[0] / 2 && std::fabs(y) <= a[1] / 2)
    n.take(t, [&] { return LocalHit{t, {0, 0, 1}, x / a[0] + 0.5, y / a[1] + 0.5}; });
}

// A flat ring at height z, facing along `up`.
template <class Found>
void ring(double inner, double outer, double z, double up, Vec3 o, Vec3 d, Found& n) {
  const double t = (z - o.z) / d.z;
  if (d.z == 0 || !n.wants(t)) return;
  const double x = o.x + t * d.x, y = o.y + t * d.y, r = std::sqrt(x * x + y * y);
  if (r >= inner && r <= outer)
    n.take(t, [&] { return LocalHit{t, {0, 0, up}, (r - inner) / (outer - inner), turns(y, x)}; });
}

// Of a box without end: the two faces that it has.
template <class Found>
void layer(const std::vector<double>& a, Vec3 o, Vec3 d, Found& n) {
  for (const int side : {0, 1}) {
    const double t = (a[static_cast<size_t>(2 + 3 * side)] - o.z) / d.z;
    if (d.z != 0 && n.wants(t))
      n.take(t, [&] { return LocalHit{t, {0, 0, side ? 1.0 : -1.0}, o.x + t * d.x, o.y + t * d.y}; });
  }
}

template <class Found>
void box(const std::vector<double>& a, Vec3 o, Vec3 d, Found& n) {
  if (is_layer(a)) return layer(a, o, d, n);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const double t = (a[3 * side + axis] - o[axis]) / d[axis];
      if (d[axis] == 0 || !n.wants(t)) continue;
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      const double u = (o[b] + t * d[b] - a[b]) / (a[3 + b] - a[b]), v = (o[c] + t * d[c] - a[c]) / (a[3 + c] - a[c]);
      if (u < 0 || u > 1 || v < 0 || v > 1) continue;
      n.take(t, [&] {
        Vec3 normal;
        normal[axis] = side ? 1 : -1;
        return LocalHit{t, normal, u, v};
      });
    }
}

template <class Found>
void sphere(double radius, Vec3 o, Vec3 d, Found& n) {
  // The discriminant from the closest approach: no cancellation for small spheres far away (Haines et al. 2019).
  const double a = dot(d, d), b = dot(o, d);
  const Vec3 closest = o - d * (b / a);
  const double gap = radius * radius - dot(closest, closest);
  if (gap < 0) return;
  const double c = dot(o, o) - radius * radius, q = -(b + std::copysign(std::sqrt(gap * a), b));
  double t[2] = {q / a, q != 0 ? c / q : q / a};
  if (t[0] > t[1]) std::swap(t[0], t[1]);
  for (const double root : t)
    if (n.wants(root))
      n.take(root, [&] {
        const Vec3 p = o + d * root;
        return LocalHit{root, p, turns(p.y, p.x), std::atan2(std::hypot(p.x, p.y), p.z) / kPi};
      });
}

// Side of a cone whose radius goes from r0 at z = 0 to r1 at z = h, with its caps.
template <class Found>
void cone(double r0, double r1, double h, bool capped, Vec3 o, Vec3 d, Found& n) {
  const double slope = (r1 - r0) / h, ro = r0 + slope * o.z, rd = slope * d.z;
  double t[2];
  double a = d.x * d.x + d.y * d.y - rd * rd;
  const double b = o.x * d.x + o.y * d.y - ro * rd, c = o.x * o.x + o.y * o.y - ro * ro;
  bool any = false;
  if (std::fabs(a) < 1e-14 * dot(d, d)) {  // along the side: one root
    any = b != 0;
    t[0] = t[1] = -c / (2 * b);
  } else {
    any = roots(a, b, c, t);
  }
  if (any)
    for (const double root : t) {
      const Vec3 p = o + d * root;
      if (!n.wants(root) || p.z < 0 || p.z > h || r0 + slope * p.z < 0) continue;
      n.take(root, [&] { return LocalHit{root, {p.x, p.y, -slope * (r0 + slope * p.z)}, turns(p.y, p.x), p.z / h}; });
    }
  if (!capped) return;
  if (r0 > 0) ring(0, r0, 0, -1, o, d, n);
  if (r1 > 0) ring(0, r1, h, 1, o, d, n);
}

// z = sum of a sin(kx x + ky y + phase).
struct Waves {
  const std::vector<double>& a;
  Vec3 o, d;
  double bound1 = 0, bound2 = 0;  // of the slope and curvature of f along the ray

  Waves(const std::vector<double>& parameters, Vec3 origin, Vec3 direction)
      : a(parameters), o(origin), d(direction), bound1(std::fabs(direction.z)) {
    for (size_t i = 2; i < a.size(); i += 4) {
      const double k = std::fabs(a[i + 1] * d.x + a[i + 2] * d.y);
      bound1 += std::fabs(a[i]) * k;
      bound2 += std::fabs(a[i]) * k * k;
    }
  }
  // Height of the ray over the surface, and how it changes along the ray.
  struct Height {
    double value, slope;
  };
  Height f(double t) const {
    Height height{o.z + t * d.z, d.z};
    for (size_t i = 2; i < a.size(); i += 4) {
      const double phase = a[i + 1] * (o.x + t * d.x) + a[i + 2] * (o.y + t * d.y) + a[i + 3];
      height.value -= a[i] * std::sin(phase);
      height.slope -= a[i] * std::cos(phase) * (a[i + 1] * d.x + a[i + 2] * d.y);
    }
    return height;
  }
  // Root between `low` and `high` where f is monotonic, or infinity: Newton's steps; halves where they leave the
  // bracket or do not end.
  double only_root(double low, double high) const {
    const double from = f(low).value, to = f(high).value;
    if (from == 0) return low;
    if ((from < 0) == (to < 0)) return INFINITY;
    double t = std::clamp(low - from * (high - low) / (to - from), low, high);
    for (int i = 0; i < 200; ++i) {
      const Height height = f(t);
      ((height.value < 0) == (from < 0) ? low : high) = t;
      const double newton = t - height.value / height.slope, before = t;
      t = i < 20 && newton > low && newton < high ? newton : 0.5 * (low + high);
      // Such a step of Newton's leaves its square, or what rounding leaves.
      const double enough = t == newton ? 1e-11 : 1e-15;
      if (std::fabs(t - before) <= enough * std::fabs(t) || high - low <= 1e-15 * std::fabs(high)) break;
    }
    return t;
  }
  // First root in (low, high), or infinity.
  double root(double low, double high, int depth) const {
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    const Height height = f(middle);
    if (std::fabs(height.value) > bound1 * half) return INFINITY;
    if (std::fabs(height.slope) > bound2 * half || depth == 60) return only_root(low, high);
    const double first = root(low, middle, depth + 1);
    return std::isfinite(first) ? first : root(middle, high, depth + 1);
  }
};

template <class Found>
void sinusoid(const std::vector<double>& a, Vec3 o, Vec3 d, Found& n) {
  // Only the part of the ray over the rectangle and between the extremes counts.
  double reach = 0;
  for (size_t i = 2; i < a.size(); i += 4) reach += std::fabs(a[i]);
  double low = n.t_min, high = n.t_max;
  const double half[3] = {a[0] / 2, a[1] / 2, reach * (1 + 1e-12) + 1e-12};
  for (int axis = 0; axis < 3; ++axis) {
    if (d[axis] == 0) {
      if (std::fabs(o[axis]) > half[axis]) return;
      continue;
    }
    double t0 = (-half[axis] - o[axis]) / d[axis], t1 = (half[axis] - o[axis]) / d[axis];
    if (t0 > t1) std::swap(t0, t1);
    low = std::max(low, t0);
    high = std::min(high, t1);
  }
  if (!(low < high)) return;
  const Waves waves(a, o, d);
  const double t = waves.root(low, high, 0);
  if (!n.wants(t)) return;
  n.take(t, [&] {
    const double x = o.x + t * d.x, y = o.y + t * d.y;
    Vec3 normal{0, 0, 1};
    for (size_t i = 2; i < a.size(); i += 4) {
      const double c = a[i] * std::cos(a[i + 1] * x + a[i + 2] * y + a[i + 3]);
      normal.x -= c * a[i + 1];
      normal.y -= c * a[i + 2];
    }
    return LocalHit{t, normal, x / a[0] + 0.5, y / a[1] + 0.5};
  });
}

template <class Found>
void meet(const Primitive& p, Vec3 o, Vec3 d, Found& n) {
  const std::vector<double>& a = p.parameters;
  switch (p.kind) {
    case PrimitiveKind::plane:
      plane(a, o, d, n);
      break;
    case PrimitiveKind::disk:
      ring(a[1], a[0], 0, 1, o, d, n);
      break;
    case PrimitiveKind::box:
      box(a, o, d, n);
      break;
    case PrimitiveKind::sphere:
      sphere(a[0], o, d, n);
      break;
    case PrimitiveKind::cone:
      cone(a[0], a[1], a[2], a[3] != 0, o, d, n);
      break;
    case PrimitiveKind::cylinder:
      cone(a[0], a[0], a[1], a[2] != 0, o, d, n);
      break;
    case PrimitiveKind::sinusoid:
      sinusoid(a, o, d, n);
      break;
  }
}

}  // namespace

std::optional<LocalHit> intersect(const Primitive& p, Vec3 o, Vec3 d, double t_min, double t_max) {
  Nearest n{{t_min, t_max}, std::nullopt};
  meet(p, o, d, n);
  return n.hit;
}

double distance_to(const Primitive& p, Vec3 o, Vec3 d, double t_min, double t_max) {
  Soonest n{t_min, t_max};
  meet(p, o, d, n);
  return n.t_max < t_max ? n.t_max : INFINITY;
}

}  // namespace suite
