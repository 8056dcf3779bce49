// The walk through a sheet of the aligned method, which encoder and decoder take together; the method is described in
// aligned.h, the syntax of a block is in block_code.h. Internal to libs/sqt and libs/sqt_fit.
#pragma once
#include <algorithm>
#include <vector>

#include "base/error.h"
#include "sqt/block_code.h"
#include "sqt/block_transform.h"
#include "sqt/cell_centers.h"
#include "sqt/coded_lattice.h"
#include "sqt/leaf_table.h"
#include "sqt/step_rule.h"

namespace suite::sqt {

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

// Quantises x (in steps): nearest, with a dead zone that saves more bits than it costs accuracy.
inline int32_t quantise(float x) {
  constexpr float kMost = 1 << 20;
  const float a = x < 0 ? -x : x;
  const int32_t n = static_cast<int32_t>((a < kMost ? a : kMost) + 0.36f);
  return x < 0 ? -n : n;
}

// One sheet being rebuilt, level by level.
template <class Coder>
class SheetWalk {
 public:
  SheetWalk(const AlignedLayout& layout, LogScale scale, const BlockTransform& transform, const StepRule& steps,
            Coder& coder, Targets* targets, LeafTable* leaves, size_t max_nodes)
      : layout_(layout),
        scale_(scale),
        transform_(transform),
        steps_(steps),
        coder_(coder),
        targets_(targets),
        leaves_(leaves),
        max_nodes_(max_nodes),
        width_(layout.width()),
        lattice_({layout.upper_only, layout.half_stored}, width_),
        blocks_(layout, transform),
        levels_(3 * width_),
        changes_(3 * (lattice_.row() + 16), int16_t{0}),
        mean_(padded_row(layout.views())),
        difference_(targets ? 3 * width_ : 0),
        coefficient_(difference_.size()) {
    if (!targets) lattice_.reserve(std::min(max_nodes, (size_t{1} << 24) / width_));
  }

  void run() {
    roots();
    size_t begin = 0, above = 0;
    while (begin < lattice_.size()) {
      const size_t end = lattice_.size();
      if (begin > 0) {
        read_splits(above, begin);
        lattice_.link(begin, end);
      }
      find_centers(begin, end);
      for (size_t i = begin; i < end; ++i) visit(i, centers_[i - begin]);
      above = begin, begin = end;
    }
  }

 private:
  // Roots, each predicted by the one before, and which of them are divided.
  void roots() {
    const float step = std::min(0.25f, static_cast<float>(layout_.quality));
    std::vector<int16_t> predicted(lattice_.row(), 0);
    std::vector<float> known(width_);
    for (size_t i = 0; i < lattice_.size(); ++i) {
      if (targets_) {
        to_source(predicted.data(), known);
        targets_->root(i, known, {difference_.data(), width_});
      }
      const int32_t block = convey(1, step, -1);
      const bool any = change(0, block, step);
      int16_t* value = lattice_.value(i);
      for (size_t j = 0; j < lattice_.row(); ++j) {
        const int sum = predicted[j] + (any && j < width_ ? change_row(0)[j] : 0);
        predicted[j] = value[j] = static_cast<int16_t>(std::clamp(sum, -LogScale::kMost, LogScale::kMost));
      }
    }
    for (size_t i = 0; i < lattice_.size(); ++i)
      lattice_.node(i).split = coder_.raw(targets_ && targets_->split(i) ? 1 : 0, 1) != 0;
  }
  // For the children of the nodes [begin, end).
  void read_splits(size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const CodedLattice::Node& node = lattice_.node(i);
      if (node.first_child < 0 || node.order + 1 >= kMaxOrder) continue;
      uint32_t mask = 0;
      if (targets_) {
        size_t child = static_cast<size_t>(node.first_child);
        for (uint32_t k = 0; k < 4; ++k)
          if (node.child_mask & (1u << k)) mask |= targets_->split(child++) ? 1u << k : 0;
      }
      mask = blocks_.code_split(coder_, mask, block_[i], lattice_.divided_around(i));
      size_t child = static_cast<size_t>(node.first_child);
      for (uint32_t k = 0; k < 4; ++k)
        if (node.child_mask & (1u << k)) lattice_.node(child++).split = (mask & (1u << k)) != 0;
    }
  }
  void find_centers(size_t begin, size_t end) {
    centers_.resize((end - begin + 7) / 8 * 8);
    for (size_t i = begin; i < end; i += 8) {
      CellLanes cells;
      for (size_t lane = 0; lane < std::min<size_t>(8, end - i); ++lane) cells.set(lane, lattice_.node(i + lane).at);
      EightFloats x, y, z;
      centers_of(cells, lattice_.node(i).order, x, y, z);
      for (size_t lane = 0; lane < 8; ++lane) centers_[i - begin + lane] = {x[lane], y[lane], z[lane]};
    }
  }
  void visit(size_t i, const Center& center) {
    lattice_.find_slopes(i);
    block_.resize(lattice_.size(), -1);
    const CodedLattice::Node& node = lattice_.node(i);
    if (!node.split) {
      if (leaves_)
        leaves_->add(node.at, node.order, center, lattice_.value(i), lattice_.slope(i, 0), lattice_.slope(i, 1));
      return;
    }
    if (lattice_.size() + 4 > max_nodes_) throw Error("SQT payload is damaged: more nodes than allowed");
    const float step = steps_.step(center, node.order, mean_of(i), find_finer(i));
    if (targets_) targets_->differences(lattice_, i, difference_);
    const int32_t block = convey(3, step, node.parent >= 0 ? block_[static_cast<size_t>(node.parent)] : -1);
    block_[i] = block;
    const int16_t* details[3];
    for (size_t d = 0; d < 3; ++d) details[d] = change(d, block, step) ? change_row(d) : nullptr;
    lattice_.divide(i, details);
    if (targets_) targets_->divided(lattice_, i);
  }
  // Octaves by which a divided node's step is finer: stated below nodes that have some.
  int find_finer(size_t i) {
    if (!layout_.refined) return 0;
    finer_.resize(lattice_.size(), 0);
    const int32_t parent = lattice_.node(i).parent;
    const int above = parent >= 0 ? finer_[static_cast<size_t>(parent)] : -1;
    if (above != 0)
      finer_[i] = static_cast<uint8_t>(
          blocks_.code_finer(coder_, targets_ ? static_cast<uint32_t>(targets_->finer(i)) : 0, above));
    return finer_[i];
  }
  // Quantises (encoder) or not (decoder) and codes the rows of differences.
  int32_t convey(size_t count, float step, int32_t above) {
    if (targets_)
      for (size_t d = 0; d < count; ++d) {
        transform_.forward({&difference_[d * width_], width_}, {&coefficient_[d * width_], width_});
        for (size_t j = 0; j < width_; ++j) levels_[d * width_ + j] = quantise(coefficient_[d * width_ + j] / step);
      }
    return blocks_.code(coder_, {levels_.data(), count * width_}, count, above);
  }
  int16_t* change_row(size_t d) { return &changes_[d * (lattice_.row() + 16)]; }
  bool change(size_t d, int32_t block, float step) {
    return transform_.inverse(&levels_[d * width_], blocks_.counts(block) + d * layout_.channels, step / scale_.unit(),
                              change_row(d));
  }
  // Log2 values of a node's views, averaged over channels.
  const float* mean_of(size_t i) {
    const size_t views = layout_.views();
    const int16_t* value = lattice_.value(i);
    const float unit = scale_.unit() / static_cast<float>(layout_.channels), offset = static_cast<float>(scale_.offset);
    for (size_t v = 0; v < views; v += 8) {  // what is read behind the views counts for nothing
      Int8 sum{};
      for (size_t c = 0; c < layout_.channels; ++c)
        sum += __builtin_convertvector(load<Short8>(value + c * views + v), Int8);
      store(&mean_[v], offset + unit * __builtin_convertvector(sum, EightFloats));
    }
    return mean_.data();
  }
  void to_source(const int16_t* row, std::span<float> values) const {
    for (size_t v = 0; v < layout_.views(); ++v)
      for (size_t c = 0; c < layout_.channels; ++c)
        values[v * layout_.channels + c] = scale_.value(static_cast<float>(row[c * layout_.views() + v]));
  }

  const AlignedLayout& layout_;
  LogScale scale_;
  const BlockTransform& transform_;
  const StepRule& steps_;
  Coder& coder_;
  Targets* targets_;
  LeafTable* leaves_;
  size_t max_nodes_, width_;
  CodedLattice lattice_;
  BlockCode blocks_;
  std::vector<int32_t> block_;  // [node] of divided nodes
  std::vector<uint8_t> finer_;  // [node] of divided nodes
  std::vector<int32_t> levels_;
  std::vector<int16_t> changes_;
  std::vector<Center> centers_;  // of the level's nodes
  std::vector<float> mean_, difference_, coefficient_;
};

// Rebuilds (and with targets: codes) one sheet. leaves: receives the leaves, or null. max_nodes bounds memory; Error
// when it is exceeded.
template <class Coder>
void walk_sheet(const AlignedLayout& layout, LogScale scale, const BlockTransform& transform, const StepRule& steps,
                Coder& coder, Targets* targets, LeafTable* leaves, size_t max_nodes) {
  SheetWalk<Coder>(layout, scale, transform, steps, coder, targets, leaves, max_nodes).run();
}
}  // namespace suite::sqt
