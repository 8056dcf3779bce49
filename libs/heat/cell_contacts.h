// Where cells touch: found from the sides of their pieces, as contacts between pairs of cells with what conduction
// along the surface needs to know of them.
//
// Method: pieces that lie on both sides of a line meet where their sides on it overlap. A pair is coupled by two-point
// fluxes (R. Eymard, T. Gallouet, R. Herbin, "Finite volume methods", Handbook of Numerical Analysis 7, 2000): length
// over the distance of the middles across the line, which is exact where the line of the middles is upright on it: for
// rectangles and their middles, and for triangles without obtuse angles and the centres of the circles around them.
// Elsewhere, among obtuse triangles and patches of odd shapes, it is an approximation.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace suite {

// A side of a piece of a cell.
struct CellSide {
  uint32_t cell = 0;
  double from = 0, to = 0;  // along the line that it lies on, from < to
  Vec3 a, b;                // m: places there
  Vec3 out;                 // out of the piece, along its surface, upright on the side; unit
};

// What two-point fluxes take a cell for.
struct CellMiddle {
  Vec3 place;       // m
  double size = 0;  // m, root of the area
};

struct CellContact {
  uint32_t a = 0, b = 0;  // cells, a < b
  double ratio = 0;       // of length to distance
};

class CellContacts {
 public:
  // All sides that lie on one line. Where more than two meet, as in a seam of three sheets, each pair has its share.
  void add_line(std::span<const CellSide> sides);
  // A part of the cell's side that another cell lies behind, told from this side alone; the other tells its own.
  void add(const CellSide& side, uint32_t other) { report(side, other, length(side.b - side.a)); }
  // middles: by cell. Cells touch once: what several lines have of a pair is put together.
  std::vector<CellContact> found(std::span<const CellMiddle> middles) &&;

 private:
  struct Part {  // of a contact, as seen by one of both
    uint32_t a, b;
    double length;
    Vec3 middle, out_a, out_b;  // of a's and b's reports, times length; zero of the other's
  };
  void report(const CellSide& side, uint32_t other, double length);
  void put_together(size_t from);  // parts of the same pair, of those from there on
  std::vector<Part> parts_;
};

}  // namespace suite
