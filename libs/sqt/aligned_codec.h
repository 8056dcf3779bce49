// What encoder and decoder of the aligned method share: the transform over views and channels, the quantisation step,
// and the walk through a sheet. Internal to libs/sqt; the method is described in aligned.h, the syntax of a block is in
// block_code.h.
#pragma once
#include <vector>

#include "sqt/aligned.h"
#include "sqt/block_code.h"
#include "sqt/coded_lattice.h"
#include "sqt/lattice.h"
#include "sqt/leaf_table.h"
#include "sqt/prefix_code.h"
#include "sqt/view_lanes.h"

namespace suite::sqt {

// Orthonormal cosine transform over channels and view angles, Fourier over view azimuths.
class BlockTransform {
 public:
  explicit BlockTransform(const AlignedLayout& layout);
  // values [view][channel] -> coefficients [channel frequency][view frequency]; layout.width() of either.
  void forward(std::span<const float> values, std::span<float> coefficients) const;
  // What levels [channel frequency][view frequency] times `step` stand for, rounded: [channel][view]. counts: how many
  // levels of each channel frequency count, those behind are 0. False when there are none; then nothing is written.
  bool inverse(const int32_t* levels, const uint16_t* counts, float step, int16_t* values) const;
  // "How high" a view frequency is, for contexts: polar plus azimuthal wave number.
  int height(size_t view_frequency) const { return height_[view_frequency]; }

 private:
  size_t views_, channels_, stride_;
  std::vector<float> view_;     // [frequency][stride]
  std::vector<float> channel_;  // [frequency][channel]
  std::vector<int> height_;
  mutable std::vector<float> mixed_;  // room for inverse, which one thread at a time calls
};

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

// Mean log2 weight that StepRule refers to, from the totals; rounded so that it can be stored in a byte.
int step_reference(const AlignedTotals& totals, const AlignedLayout& layout);

// What the encoder wants; a decoder has none. Nodes are named by their index in the lattice being rebuilt.
class Targets {
 public:
  virtual ~Targets() = default;
  virtual bool split(size_t node) = 0;
  // Octaves by which the step of a divided node is finer than its values say.
  virtual int finer(size_t node) = 0;
  // Differences [detail][view][channel] that the block of this node should convey, given what was decoded so far.
  virtual void differences(const CodedLattice& lattice, size_t node, std::span<float> details) = 0;
  virtual void root(size_t node, std::span<const float> predicted, std::span<float> difference) = 0;
  // The node has been divided: children follow in the lattice's order.
  virtual void divided(const CodedLattice& lattice, size_t node) = 0;
};

// Rebuilds (and with targets: codes) one sheet. leaves: receives the leaves, or null. max_nodes bounds memory; Error
// when it is exceeded.
template <class Coder>
void walk_sheet(const AlignedLayout& layout, LogScale scale, const BlockTransform& transform, const StepRule& steps,
                Coder& coder, Targets* targets, LeafTable* leaves, size_t max_nodes);

// Quantises x (in steps): nearest, with a dead zone that saves more bits than it costs accuracy.
inline int32_t quantise(float x) {
  constexpr float kMost = 1 << 20;
  const float a = x < 0 ? -x : x;
  const int32_t n = static_cast<int32_t>((a < kMost ? a : kMost) + 0.36f);
  return x < 0 ? -n : n;
}

// Children that are not known, in terms of those that are: the mirror image across the symmetry plane, else `rest` of
// the sum and the number of those known. present: bit k set when child k is known; v: the four children's numbers,
// filled in place.
template <class Rest>
void complete(unsigned present, float (&v)[4], Rest rest) {
  if (present == 15) return;
  if (!(present & 2) && (present & 4)) v[1] = v[2], present |= 2;
  if (!(present & 4) && (present & 2)) v[2] = v[1], present |= 4;
  float sum = 0;
  int n = 0;
  for (int k = 0; k < 4; ++k)
    if (present & (1u << k)) sum += v[k], ++n;
  for (int k = 0; k < 4; ++k)
    if (!(present & (1u << k))) v[k] = n ? rest(sum, n) : 0;
}
// Values: the unknown ones are the mean of the others, which is the parent's.
inline void complete_values(unsigned present, float (&v)[4]) {
  complete(present, v, [](float sum, int n) { return sum / static_cast<float>(n); });
}
// Differences from a prediction: three details cannot move a family's mean, so those that nobody will look at take up
// what keeps it where it is and the known ones exact.
inline void complete_differences(unsigned present, float (&v)[4]) {
  complete(present, v, [](float sum, int n) { return -sum / static_cast<float>(4 - n); });
}

}  // namespace suite::sqt
