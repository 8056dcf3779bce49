// Cells of the sphere: the HEALPix partition in its nested order, twelve quad-trees of equal-area cells.
//
// A face is one of the twelve base cells, with coordinates (x, y) in [0, 1)^2; x grows to the north-east, y to the
// north-west. The map (x, y) -> direction preserves area, so a uniform point of the square is a uniform direction of
// the cell. Assumes nothing about units; directions are unit vectors.
//
// Based on: Gorski et al., "HEALPix: a framework for high-resolution discretization ...", ApJ 622, 2005, section 5 and
// appendix; Goodenough & Brown, section IV-D-4.
#pragma once
#include <array>
#include <cstdint>

#include "math/vec.h"

namespace suite::sqt {

inline constexpr int kMaxOrder = 13;                     // codes fit 32 bits
inline constexpr double kFaceSolidAngle = 4 * kPi / 12;  // sr

// A point of the sphere in face coordinates; exact inverse of each other up to rounding.
struct FacePoint {
  int face = 0;
  double x = 0, y = 0;  // [0, 1)
};
FacePoint face_point(Dir d);  // d a unit vector
// The same with an azimuth that is right to 1e-8 rad, in a third of the time; for finding cells. The second form takes
// the azimuth from (x, y), of any length, and z with 1 - z^2 = s2.
FacePoint face_point_fast(Dir d);
FacePoint face_point_fast(double x, double y, double z, double s2);
Dir direction(FacePoint p);       // x, y in [0, 1]
Dir direction_fast(FacePoint p);  // within 1e-11 of it, in half the time

// Order (0..13) and nested index in one integer: 4^(order+1) + index (the "unique" numbering of HEALPix).
struct CellId {
  uint32_t code = 4;

  static constexpr CellId of(int order, uint32_t index) { return {(4u << (2 * order)) + index}; }
  constexpr int order() const { return (31 - __builtin_clz(code)) / 2 - 1; }  // index < 12 * 4^order keeps the top bits
  constexpr uint32_t index() const { return code - (4u << (2 * order())); }
  constexpr int face() const { return static_cast<int>(index() >> (2 * order())); }
  constexpr CellId child(uint32_t k) const { return of(order() + 1, 4 * index() + k); }  // k = 2 ybit + xbit
  constexpr CellId parent() const { return of(order() - 1, index() / 4); }
  constexpr bool operator==(const CellId&) const = default;
};

// Number of cells of the whole sphere and solid angle of one cell, sr.
constexpr uint32_t cell_count(int order) { return 12u << (2 * order); }
inline double cell_solid_angle(int order) { return kFaceSolidAngle / static_cast<double>(1u << (2 * order)); }

// Integer coordinates of a cell in its face, 0..2^order-1.
struct CellXY {
  int face = 0;
  uint32_t x = 0, y = 0;
  constexpr bool operator==(const CellXY&) const = default;
};
CellXY xy_of(CellId cell);
CellId cell_at(int order, CellXY at);
CellId cell_of(FacePoint p, int order);  // the cell that contains p
inline CellId cell_of(Dir d, int order) { return cell_of(face_point(d), order); }

// The point of the unit square (u.x, u.y) inside the cell; uniform in, uniform out.
FacePoint point_in(CellId cell, Vec2 u);
inline Dir direction_in(CellId cell, Vec2 u) { return direction(point_in(cell, u)); }
// direction_in at ((i + 0.5) / side, (j + 0.5) / side) for all i, j < side, at [j * side + i] of x, y, z: the same
// bits, with sines and cosines of an azimuth once for all points of the grid that share it. side: 1 to 32.
void directions_in(CellId cell, int side, double* x, double* y, double* z);
inline Dir center_of(CellId cell) { return direction_in(cell, {0.5, 0.5}); }

// The four cells of the same order across the edges: -x, +x, -y, +y; or one of them (edge 0..3).
std::array<CellId, 4> edge_neighbours(CellId cell);
CellXY neighbour(CellXY cell, int order, size_t edge);

// Integral of max(cos theta, 0), or of |cos theta| with both_sides, over a cell, sr; exact (z depends on x + y alone
// and is piecewise quadratic in it).
double cosine_integral(CellId cell, bool both_sides = false);

// Mirror image under y -> -y of directions (azimuth phi -> -phi).
CellId mirrored(CellId cell);
CellXY mirrored(CellXY cell);
// Whether a cell is its own mirror image.
constexpr bool on_mirror(CellXY c) { return c.x == c.y && (c.face == 4 || c.face == 6); }

}  // namespace suite::sqt
