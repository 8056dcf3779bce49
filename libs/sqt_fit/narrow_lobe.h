// A lobe narrower than the finest cell, taken apart from the rest of a function: it becomes a Dirac lobe that keeps its
// energy, instead of being smeared over a cell.
//
// The lobe is looked for where lobes can be told apart from cells: around the mirror direction, the direction back to
// the viewer, and straight on. With w the width of a cell of the finest order, "narrower" means that more than half of
// what stands out within 4 w of the lobe's axis (in the angle of the half vector) lies within w / 2.
#pragma once
#include <memory>
#include <string>

#include "sqt/function.h"

namespace suite::sqt {

struct NarrowLobe {
  std::shared_ptr<const Function> rest;  // levelled off within `core`, with dirac() and dirac_total()
  double largest = 0;                    // part of the total that the lobe has at most, over views up to 75 deg
  double core = 0;                       // half-vector angle, rad
  std::string where;                     // "mirror direction", ...
};

// rest is null when there is no such lobe (or the function is no surface, or knows its Dirac lobe already).
NarrowLobe split_narrow_lobe(std::shared_ptr<const Function> function, int finest_order);

}  // namespace suite::sqt
