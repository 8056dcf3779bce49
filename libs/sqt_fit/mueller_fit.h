// Mueller matrices of a measurement, thinned to the nodes that linear interpolation needs, made possible where noise
// has left what exists, and in whole numbers (sqt/mueller_table.h).
#pragma once
#include <memory>

#include "sqt/mueller_table.h"
#include "sqt_fit/mueller_brdf.h"

namespace suite::sqt {

// Of the elements over m11, which lie within [-1, 1], at all nodes of the data above the horizon, beside the data made
// possible.
struct MuellerErrors {
  double rms = 0;      // nodes count by solid angle and both cosines
  double lit = 0;      // the same times m11: what light sees
  double largest = 0;  // of any element
};
struct MuellerFit {
  std::shared_ptr<const MuellerTable> table;
  MuellerErrors errors;
  double changed = 0;       // share of the data's matrices that could not exist (an eigenvalue below -1e-3)
  double most_changed = 0;  // rms of the elements of these, before against after
};
// rms_error: nodes are left out while `rms` stays about that, > 0; 0: all nodes of the data are kept.
MuellerFit fit_mueller(const MuellerBrdf& brdf, double rms_error);

}  // namespace suite::sqt
