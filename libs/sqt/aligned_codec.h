// What encoder and decoder of the aligned method share: the transform over views and channels, the quantisation step,
// and the entropy model of a block. Internal to libs/sqt; the method is described in aligned.h.
#pragma once
#include <array>
#include <vector>

#include "sqt/aligned.h"
#include "sqt/lattice.h"
#include "sqt/range_coder.h"

namespace suite::sqt {

// Orthonormal cosine transform over channels and view angles, Fourier over view azimuths.
class BlockTransform {
 public:
  explicit BlockTransform(const AlignedLayout& layout);
  // values [view][channel] <-> coefficients [channel frequency][view frequency]; coefficient count = layout.width().
  void forward(std::span<const float> values, std::span<float> coefficients) const;
  void inverse(std::span<const float> coefficients, std::span<float> values) const;
  // "How high" a view frequency is, for contexts: polar plus azimuthal wave number.
  int height(size_t view_frequency) const { return height_[view_frequency]; }

 private:
  size_t views_, channels_;
  std::vector<float> view_, channel_;  // [frequency][index]
  std::vector<int> height_;
};

// Quantisation step of the differences below a node: small where a cell weighs much in the cosine-weighted error.
class StepRule {
 public:
  // reference: log2 of the mean weight of a cell direction.
  StepRule(const AlignedLayout& layout, double reference);
  float step(CellId cell, std::span<const float> value) const;

 private:
  const AlignedLayout& layout_;
  double reference_, log2_quality_;
  std::vector<LobeMap> maps_;
  std::vector<float> view_weight_;
};

// Mean log2 weight that StepRule refers to, from the totals; rounded so that it can be stored in a byte.
int step_reference(const AlignedTotals& totals, const AlignedLayout& layout);

// Entropy model of all syntax elements. Coder: RangeEncoder (codes what it is given) or RangeDecoder (fills in).
class BlockModel {
 public:
  BlockModel(const AlignedLayout& layout, const BlockTransform& transform);
  // block: `details` (1 for roots, 3 otherwise) x channel frequency x view frequency quantised levels; parent: the
  // block of the node above, or empty.
  template <class Coder>
  void code(Coder& coder, std::span<int32_t> block, size_t details, std::span<const int32_t> parent, int order);
  template <class Coder>
  bool code_split(Coder& coder, bool split, int order, int divided_around, bool parent_busy);

 private:
  using Magnitude = std::array<BitContext, 20>;
  template <class Coder>
  int code_magnitude(Coder& coder, int magnitude, Magnitude& contexts);
  size_t views_, channels_;
  std::vector<int> view_class_;
  std::vector<BitContext> any_, significant_, last_, split_;
  std::vector<Magnitude> magnitude_;
  std::vector<int32_t> nothing_;  // a row of zeros
};

// What the encoder wants; a decoder has none. Nodes are named by their index in the lattice being rebuilt.
class Targets {
 public:
  virtual ~Targets() = default;
  virtual bool split(size_t node) = 0;
  // Differences [detail][view][channel] that the block of this node should convey, given what was decoded so far.
  virtual void differences(const Lattice& lattice, size_t node, std::span<float> details) = 0;
  virtual void root(size_t node, std::span<const float> predicted, std::span<float> difference) = 0;
  // The node has been divided: children follow in the lattice's order.
  virtual void divided(const Lattice& lattice, size_t node) = 0;
};

// Rebuilds (and with targets: codes) one sheet. max_nodes bounds memory; Error when it is exceeded.
template <class Coder>
Lattice walk_sheet(const AlignedLayout& layout, const BlockTransform& transform, const StepRule& steps, Coder& coder,
                   Targets* targets, size_t max_nodes);

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
