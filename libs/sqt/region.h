// Which cells of the sphere a sheet of the aligned method stores. Internal to libs/sqt and libs/sqt_fit.
#pragma once
#include "sqt/cell.h"

namespace suite::sqt {

// Which cells a sheet has.
struct Region {
  static constexpr int kRootOrder = 1;  // of the coarsest cells of a pyramid
  bool upper_only = true;               // only cells that reach above z = 0
  bool half_only = true;                // only cells that reach azimuths in [0, pi]; the others are their mirror images
  bool holds(CellId id) const { return holds(xy_of(id), id.order()); }
  bool holds(CellXY cell, int order) const;
};

}  // namespace suite::sqt
