// The bundle made of the paper's own spherical quad-trees; libs/sqt_fit builds them.
//
// One tree per view direction and channel: samples are inserted at full order, averaged, empty cells aggregated into
// their parents, families of similar values consolidated. Values are constant over a leaf. Between view directions the
// shapes are blended linearly in the fixed frame of the surface; the shape is scaled to the total that the data had
// before reduction.
//
// Based on: Goodenough & Brown, section IV-D-4 (construction) and V-A (totals before reduction, magnitudes).
#pragma once
#include <memory>
#include <vector>

#include "sqt/bundle.h"

namespace suite::sqt {

struct PaperLeaf {
  CellId id;
  float value;  // >= 0: negative averages become 0 and are counted
};

struct PaperData {
  Function::Info function;
  std::vector<Bundle::View> views;              // isotropic: phi = 0, theta ascending; else theta-major over phi_count
  size_t phi_count = 1;                         // view azimuths per polar angle, uniform from 0
  std::vector<std::vector<PaperLeaf>> slices;   // [view][channel] flattened; values are f, 1/sr
  std::vector<double> magnitude_um;             // ascending
  std::vector<float> magnitudes;                // [view][magnitude] totals W before reduction
  std::shared_ptr<const MuellerTable> mueller;  // null: nothing is known of polarisation
};

// Checks every invariant (sizes, ranges, disjoint leaves). Error naming the fault when the data are inconsistent.
std::shared_ptr<const Bundle> make_bundle(PaperData data);

}  // namespace suite::sqt
