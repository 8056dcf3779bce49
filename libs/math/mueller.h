// Stokes vectors (I, Q, U, V), Mueller matrices and the frames that they are told in: CONVENTIONS.md, "Polarisation".
//
// A matrix takes light that travels along one direction to light along another; each is told in the meridian frame of
// its direction of travel, which depends on that direction and z alone. Matrices of neighbouring events therefore
// multiply as they are, and nothing has to be carried along a path.
#pragma once
#include <array>
#include <cmath>
#include <string_view>

#include "math/vec.h"

namespace suite {

using Stokes = std::array<double, 4>;

struct Mueller {
  std::array<double, 16> m{};  // row-major
  constexpr double operator()(int row, int column) const { return m[static_cast<size_t>(4 * row + column)]; }
  constexpr double& operator()(int row, int column) { return m[static_cast<size_t>(4 * row + column)]; }
  static constexpr Mueller identity() { return diagonal(1, 1, 1, 1); }
  static constexpr Mueller depolariser() { return diagonal(1, 0, 0, 0); }
  static constexpr Mueller diagonal(double i, double q, double u, double v) {
    Mueller r;
    r(0, 0) = i, r(1, 1) = q, r(2, 2) = u, r(3, 3) = v;
    return r;
  }
  constexpr Mueller operator*(const Mueller& b) const {
    Mueller r;
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) r(i, j) += (*this)(i, k) * b(k, j);
    return r;
  }
  constexpr Stokes operator*(const Stokes& s) const {
    Stokes r{};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) r[static_cast<size_t>(i)] += (*this)(i, j) * s[static_cast<size_t>(j)];
    return r;
  }
  constexpr Mueller operator*(double s) const {
    Mueller r = *this;
    for (double& x : r.m) x *= s;
    return r;
  }
  constexpr Mueller operator+(const Mueller& b) const {
    Mueller r = *this;
    for (size_t i = 0; i < 16; ++i) r.m[i] += b.m[i];
    return r;
  }
  constexpr Mueller transposed() const {
    Mueller r;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) r(i, j) = (*this)(j, i);
    return r;
  }
  bool operator==(const Mueller&) const = default;
};

// Frame of light that travels along k, a unit vector: (e1, e2, k) right-handed, +Q along e1, +U half-way to e2.
struct PolarFrame {
  Vec3 e1, e2;
};
// e2 = z x k horizontal, e1 = e2 x k in the plane of z and k; for upright k e2 = +y.
inline PolarFrame meridian_frame(Dir k) {
  const double s2 = k.x * k.x + k.y * k.y;
  if (!(s2 > 1e-30)) return {{std::copysign(1.0, k.z), 0, 0}, {0, 1, 0}};
  const double s = std::sqrt(s2), cx = k.x / s, cy = k.y / s;
  return {{cx * k.z, cy * k.z, -s}, {-cy, cx, 0}};
}

// Takes light from a frame (e1, e2) to one (f1, f2) about the same direction: c = f1.e1, s = f1.e2, c^2 + s^2 = 1.
constexpr Mueller frame_rotation(double c, double s) {
  Mueller r = Mueller::identity();
  r(1, 1) = r(2, 2) = c * c - s * s;
  r(1, 2) = 2 * c * s;
  r(2, 1) = -2 * c * s;
  return r;
}
inline Mueller frame_rotation(const PolarFrame& from, const Vec3& f1) {
  return frame_rotation(dot(f1, from.e1), dot(f1, from.e2));
}

// The form that matrices of mirrors and of spheres have in the plane of incidence (or scattering), basis (p, s, k), p
// in the plane, s across: the blocks (a b; b a) and (c d; -d c).
struct PlaneBlocks {
  double a = 1, b = 0, c = 0, d = 0;
  double a2 = 1;  // m22
  double c2 = 0;  // m44
  static constexpr PlaneBlocks of(double a, double b, double c, double d) { return {a, b, c, d, a, c}; }
  constexpr PlaneBlocks operator*(double s) const { return {a * s, b * s, c * s, d * s, a2 * s, c2 * s}; }
  constexpr PlaneBlocks operator+(const PlaneBlocks& o) const {
    return {a + o.a, b + o.b, c + o.c, d + o.d, a2 + o.a2, c2 + o.c2};
  }
  constexpr Mueller matrix() const {
    Mueller m;
    m(0, 0) = a, m(1, 1) = a2, m(0, 1) = m(1, 0) = b;
    m(2, 2) = c, m(3, 3) = c2, m(2, 3) = d, m(3, 2) = -d;
    return m;
  }
};

// Elements, of axis (c, s) = cosine and sine of its angle from e1 towards e2. A polarizer passes `across` of the
// intensity across its axis and all along it; a retarder delays what is across its (fast) axis by a phase, rad.
constexpr Mueller turned_by(const PlaneBlocks& blocks, double c, double s) {
  return frame_rotation(c, -s) * blocks.matrix() * frame_rotation(c, s);
}
inline Mueller polarizer(double angle, double across = 0) {
  const PlaneBlocks b = PlaneBlocks::of(0.5 * (1 + across), 0.5 * (1 - across), std::sqrt(across), 0);
  return turned_by(b, std::cos(angle), std::sin(angle));
}
inline Mueller retarder(double angle, double phase) {
  return turned_by(PlaneBlocks::of(1, 0, std::cos(phase), -std::sin(phase)), std::cos(angle), std::sin(angle));
}

// The plane through two directions that point away from a place: what light from `in` to `out` has to be turned by
// before and after a matrix told in that plane. Where the directions lie on one line any plane does, and one through z
// is taken.
class ScatteringPlane {
 public:
  ScatteringPlane(Dir out, Dir in) {
    const Dir k_in = -in;
    const Vec3 across = cross(k_in, out);
    const double size = length(across);
    const Vec3 s = size > 1e-14 ? across / size : meridian_frame(k_in).e2;
    const Vec3 p_in = cross(s, k_in);
    const PolarFrame at_in = meridian_frame(k_in), at_out = meridian_frame(out);
    in_ = {dot(p_in, at_in.e1), dot(p_in, at_in.e2)};
    const Vec3 p_out = cross(s, out);
    out_ = {dot(at_out.e1, p_out), dot(at_out.e1, s)};
  }
  // The matrix of `blocks` between the meridian frames of both directions of travel.
  Mueller matrix(const PlaneBlocks& blocks) const { return turned(blocks.matrix()); }
  Mueller turned(const Mueller& m) const { return frame_rotation(out_.x, out_.y) * m * frame_rotation(in_.x, in_.y); }

 private:
  Vec2 in_, out_;  // cosine and sine of both turns
};

// A matrix between meridian frames of a local frame, between those of the world. out, in: away from the place, in the
// world. The local frame (x, y, z) may be left-handed.
Mueller to_world(const Mueller& local, const Frame& frame, Dir out, Dir in);

// Least eigenvalue of the coherency matrix H = 1/4 sum m_ij sigma_i x sigma_j*: a matrix is that of something that
// exists when none is negative. Based on: S. R. Cloude, "Group theory and polarisation algebra", Optik 75, 1986.
double least_coherency(const Mueller& m);

// Conventions of others, by the signs that their I, Q, U, V have where ours are positive: S_theirs = D S_ours.
struct StokesConvention {
  std::string_view name, remark;
  Stokes signs;
};
// The table of CONVENTIONS.md.
inline constexpr StokesConvention kStokesConventions[] = {
    {"meridian", "ours; PSTAR, MYSTIC and the IPRT tables with azimuths from x towards y", {1, 1, 1, 1}},
    {"scatmech", "basis psps", {1, -1, -1, 1}},
    {"bohren_huffman", "e_perp x e_par = k; also IPOL and SHDOM", {1, 1, -1, -1}},
    {"mitsuba", "exp(+i w t), V clockwise as the receiver sees it", {1, 1, 1, -1}},
    {"natraj", "Natraj et al. 2009", {1, -1, -1, 1}},
};
// D M D.
constexpr Mueller converted(const Mueller& m, const StokesConvention& to) {
  Mueller r;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) r(i, j) = to.signs[static_cast<size_t>(i)] * m(i, j) * to.signs[static_cast<size_t>(j)];
  return r;
}

}  // namespace suite
