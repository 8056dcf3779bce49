// Which of the images of a lamp a place asks: in a scene that repeats itself every lamp stands in every cell.
//
// One image of the cell is drawn, then a lamp in it. The 3 x 3 cells around the place are weighed by how far their
// lamps are; those beyond are drawn in rings with a tail as that of the light that lamps at one height send on a level
// surface (per lamp as r^-3). Every image has a positive probability, known exactly, so the choice is unbiased for any
// light. Internal to lamps.
#pragma once
#include "trace/tracer.h"

namespace suite {

class LampImages {
 public:
  // lamps: box of the lamps of one cell, m ENU.
  LampImages(const Periodic& cell, const Box3& lamps);

  struct Image {
    Vec3 shift;  // from the lamps of the box to the image, whole cells
    double probability;
  };
  // u in [0, 1).
  Image draw(Vec3 from, double u) const;
  // Of the image with this shift (to a small part of a cell) being drawn.
  double probability(Vec3 from, Vec3 shift) const;
  // The shift, in whole cells, that is nearest to a vector.
  Vec3 whole(Vec3 shift) const;

 private:
  // What depends on the place alone.
  struct Place {
    double cell[2];   // that it lies in
    double near[9];   // probabilities of the 3 x 3 cells around it, rows of x
    double beyond;    // of all others
    double softness;  // of the tail, rings
  };
  Place at(Vec3 from) const;
  // Cells of the rings up to m >= 1 along an axis, from the middle one to the last.
  double reach(int axis, double m) const { return 1 + (m - 1) * stretch_[axis]; }
  double cells_to(double m) const { return (2 * reach(0, m) + 1) * (2 * reach(1, m) + 1); }

  double low_[2], size_[2];
  double stretch_[2];  // cells that a ring is wide, so that rings are about square
  double widest_;      // m, of a cell
  Box3 lamps_;
};

}  // namespace suite
