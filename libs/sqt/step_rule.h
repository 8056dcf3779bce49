// How coarsely the aligned method quantises the differences below a node. Internal to libs/sqt and libs/sqt_fit.
#pragma once
#include "sqt/view_lanes.h"

namespace suite::sqt {

// Quantisation step of the differences below a node: small where a cell weighs much in the cosine-weighted error.
class StepRule {
 public:
  // reference: log2 of the mean weight of a cell direction.
  StepRule(const AlignedLayout& layout, double reference);
  // Of a cell; mean: log2 values of the views, averaged over channels; padded_row(views) of them, what follows the
  // views counts for nothing. finer: octaves that the node states (AlignedLayout::refined).
  float step(const Center& center, int order, const float* mean, int finer) const;
  // The octaves a node should state so that the step is that of a cell of these mean values instead; 0 to kMostFiner.
  int finer(const Center& center, int order, const float* mean, const float* should) const;

 private:
  const AlignedLayout& layout_;
  double reference_, log2_quality_;
  ViewLanes lanes_;
  float norm_ = 0;
  double wanted(const Center& center, int order, const float* mean) const;  // log2 of the step, not limited
};

}  // namespace suite::sqt
