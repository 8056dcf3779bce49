// Small vectors, frames and affine transforms in double precision. See CONVENTIONS.md for axes and signs.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

namespace suite {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180;

struct Vec2 {
  double x = 0, y = 0;
};

struct Vec3 {
  double x = 0, y = 0, z = 0;
  constexpr double operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  constexpr double& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr Vec3 operator+(Vec3 b) const { return {x + b.x, y + b.y, z + b.z}; }
  constexpr Vec3 operator-(Vec3 b) const { return {x - b.x, y - b.y, z - b.z}; }
  constexpr Vec3 operator*(double s) const { return {x * s, y * s, z * s}; }
  constexpr Vec3 operator/(double s) const { return {x / s, y / s, z / s}; }
  constexpr Vec3 operator-() const { return {-x, -y, -z}; }
  constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
  constexpr Vec3& operator-=(Vec3 b) { return *this = *this - b; }
  constexpr Vec3& operator*=(double s) { return *this = *this * s; }
  constexpr bool operator==(const Vec3&) const = default;
};
constexpr Vec3 operator*(double s, Vec3 v) { return v * s; }
constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec3 v) { return std::sqrt(dot(v, v)); }
inline Vec3 normalized(Vec3 v) { return v / length(v); }
inline bool finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// A unit vector; the name says what is meant.
using Dir = Vec3;

inline Dir dir_from_angles(double theta, double phi) {
  const double s = std::sin(theta);
  return {s * std::cos(phi), s * std::sin(phi), std::cos(theta)};
}
// Angle between unit vectors, exact near 0 and pi (Kahan's atan2 form; acos loses half the digits there).
inline double angle_between(Dir a, Dir b) { return 2 * std::atan2(length(a - b), length(a + b)); }
// Polar angle of a unit vector from +z, exact near the poles.
inline double polar_angle(Dir d) { return std::atan2(std::hypot(d.x, d.y), d.z); }
inline double azimuth(Dir d) { return std::atan2(d.y, d.x); }
// Compass degrees (clockwise from north = +y) to mathematical radians (from east = +x towards north).
inline double azimuth_from_compass_deg(double compass_deg) { return (90.0 - compass_deg) * kDegree; }

// Right-handed orthonormal frame; rows map world to local.
struct Frame {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  // Any frame around a unit z. Based on: Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017.
  static Frame around(Dir n) {
    const double sign = std::copysign(1.0, n.z), a = -1.0 / (sign + n.z), b = n.x * n.y * a;
    return {{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }
  // z exactly n, x as near to `tangent` as it can be; falls back to around(n) when they are parallel.
  static Frame with_tangent(Dir n, Vec3 tangent) {
    const Vec3 t = tangent - n * dot(tangent, n);
    const double len = length(t);
    if (!(len > 1e-9 * length(tangent))) return around(n);
    // Projected a second time: for a tangent almost along n the first projection loses up to nine digits.
    const Vec3 x = normalized(t / len - n * (dot(t, n) / len));
    return {x, cross(n, x), n};
  }
  Vec3 to_local(Vec3 v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3 to_world(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
};

// Affine map p -> A p + b, rows of A then b; composes in double.
struct Affine3 {
  std::array<double, 9> a{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major
  Vec3 b;
  Vec3 vector(Vec3 v) const {
    return {a[0] * v.x + a[1] * v.y + a[2] * v.z, a[3] * v.x + a[4] * v.y + a[5] * v.z,
            a[6] * v.x + a[7] * v.y + a[8] * v.z};
  }
  Vec3 point(Vec3 p) const { return vector(p) + b; }
  // Normals transform with the cofactor matrix (inverse transpose times determinant), which exists for any scale and
  // keeps the orientation right for mirrored transforms; not normalised.
  Vec3 normal(Vec3 n) const {
    const Vec3 r0{a[0], a[1], a[2]}, r1{a[3], a[4], a[5]}, r2{a[6], a[7], a[8]};
    return {dot(cross(r1, r2), n), dot(cross(r2, r0), n), dot(cross(r0, r1), n)};
  }
  double determinant() const {
    return dot(cross(Vec3{a[0], a[1], a[2]}, Vec3{a[3], a[4], a[5]}), Vec3{a[6], a[7], a[8]});
  }
  // this after `first`.
  Affine3 operator*(const Affine3& first) const {
    Affine3 r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        r.a[3 * i + j] = a[3 * i] * first.a[j] + a[3 * i + 1] * first.a[3 + j] + a[3 * i + 2] * first.a[6 + j];
    r.b = point(first.b);
    return r;
  }
  // Requires determinant() != 0.
  Affine3 inverse() const {
    const Vec3 r0{a[0], a[1], a[2]}, r1{a[3], a[4], a[5]}, r2{a[6], a[7], a[8]};
    const double inv = 1 / determinant();
    const Vec3 c0 = cross(r1, r2) * inv, c1 = cross(r2, r0) * inv, c2 = cross(r0, r1) * inv;
    Affine3 r;
    r.a = {c0.x, c1.x, c2.x, c0.y, c1.y, c2.y, c0.z, c1.z, c2.z};
    r.b = -r.vector(b);
    return r;
  }
  bool operator==(const Affine3&) const = default;
};
inline Affine3 translation(Vec3 t) { return {{1, 0, 0, 0, 1, 0, 0, 0, 1}, t}; }
inline Affine3 scaling(Vec3 s) { return {{s.x, 0, 0, 0, s.y, 0, 0, 0, s.z}, {}}; }
// Rotation by `angle` about a unit axis (Rodrigues).
inline Affine3 rotation(Dir k, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), h = std::sin(angle / 2), v = 2 * h * h;  // v = 1 - cos, exact
  return {
      {c + k.x * k.x * v, k.x * k.y * v - k.z * s, k.x * k.z * v + k.y * s, k.y * k.x * v + k.z * s, c + k.y * k.y * v,
       k.y * k.z * v - k.x * s, k.z * k.x * v - k.y * s, k.z * k.y * v + k.x * s, c + k.z * k.z * v},
      {}};
}

struct Box3 {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  bool empty() const { return !(low.x <= high.x); }
  void grow(Vec3 p) {
    low = {std::fmin(low.x, p.x), std::fmin(low.y, p.y), std::fmin(low.z, p.z)};
    high = {std::fmax(high.x, p.x), std::fmax(high.y, p.y), std::fmax(high.z, p.z)};
  }
  void grow(const Box3& o) {
    if (!o.empty()) grow(o.low), grow(o.high);
  }
  Vec3 center() const { return (low + high) * 0.5; }
  Vec3 size() const { return high - low; }
};

// A ray with the time of its photon. Directions are unit vectors.
struct Ray {
  Vec3 origin;
  Dir direction;
  double time = 0;  // s, simulation time
  uint32_t draw =
      0;  // number of the random draw this ray belongs to; surfaces with holes decide by it (trace/hit_filter.h)
  // Member by member: a temporary would be written in small pieces and read back in large ones, for which processors
  // wait.
  void set(const Vec3& from, const Dir& along, double at, uint32_t number) {
    origin = from;
    direction = along;
    time = at;
    draw = number;
  }
};

}  // namespace suite
