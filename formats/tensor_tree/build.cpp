#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "formats/tensor_tree/grid.h"
#include "formats/tensor_tree/tensor_tree.h"

namespace suite {

namespace {

constexpr int kMostLevels = 15;          // Radiance draws from squares of 2^-16
constexpr double kGrazing = 0.1736482;   // cos 80 deg, where the error's measure ends
constexpr double kBeyond = 0.1;          // what errors beyond it count
constexpr double kBeforeMerging = 0.95;  // of the error; merging adds the rest at most

// Cells are cut so far whatever is found in them; those through which mirror or return directions go, farther: a lobe
// between the points that are asked must not be missed.
int even_levels(size_t rank) { return rank == 3 ? 5 : 3; }
int lobe_levels(size_t rank) { return rank == 3 ? 10 : 5; }

// What is written is what the tree has.
float written(double value) { return std::strtof(strf("%.5g", value).c_str(), nullptr); }

}  // namespace

class TensorTreeBuilder {
 public:
  TensorTreeBuilder(TensorTree& tree, const sqt::Function& function, size_t channel)
      : tree_(tree), function_(function), channel_(channel), rank_(tree.rank_), branches_(size_t{1} << rank_) {}

  void build(const TensorTree::Aim& aim) {
    tree_.nodes_.assign(1, {});
    leaves_.assign(1, {});
    ask(0);
    while (split(all_due())) {
    }
    TensorTree::Aim own = aim;
    own.error *= kBeforeMerging;
    for (bool kept = false; !kept;) {
      while (split(worst(own))) {
      }
      tree_.full_ = left() > own.error * sum();
      const double found = aim.measure && !tree_.full_ ? aim.measure(tree_) : 0;
      kept = !(found > kBeforeMerging * aim.error);  // nan: of a function that is 0 everywhere
      if (!kept) own.error *= std::clamp(kBeforeMerging * aim.error / found, 0.5, 0.97);
    }
    merge(0, {}, (1 - kBeforeMerging) * std::max(aim.error * sum(), left()) / static_cast<double>(leaves_.size()));
    compact();
  }

 private:
  struct Leaf {
    uint32_t node = 0;
    std::array<uint16_t, 4> place{};  // in cells of its level
    uint8_t level = 0;
    float error = 0, sum = 0;  // of |f - mean| and f over the leaf, both weighed
  };

  // Of all leaves.
  double left() const {
    double total = 0;
    for (const Leaf& leaf : leaves_) total += leaf.error;
    return total;
  }
  double sum() const {
    double total = 0;
    for (const Leaf& leaf : leaves_) total += leaf.sum;
    return total;
  }

  // Whether a line or plane of mirror or return directions touches the cell.
  bool on_lobe(const Leaf& leaf) const {
    const double width = std::ldexp(1.0, -leaf.level);
    auto meets = [&](size_t i, double from, double to) {
      const double low = leaf.place[i] * width;
      return low <= to && low + width >= from;
    };
    bool mirror = true, retro = true;
    if (rank_ == 3) {
      const double low = leaf.place[0] * width, high = low + width;
      if (low >= 0.5 || !meets(2, 0.5, 0.5)) return false;
      return meets(1, 1 - high, 1 - low) || meets(1, low, high);
    }
    for (size_t i = 0; i < 2; ++i) {
      const double low = leaf.place[i] * width, high = low + width;
      mirror = mirror && meets(i + 2, low, high);
      retro = retro && meets(i + 2, 1 - high, 1 - low);
    }
    return mirror || retro;
  }
  bool due(const Leaf& leaf) const {
    if (rank_ == 3 && leaf.level && leaf.place[0] >> (leaf.level - 1)) return false;  // no direction has these
    return leaf.level < even_levels(rank_) || (leaf.level < lobe_levels(rank_) && on_lobe(leaf));
  }

  std::vector<size_t> all_due() const {
    std::vector<size_t> list;
    for (size_t i = 0; i < leaves_.size(); ++i)
      if (due(leaves_[i])) list.push_back(i);
    return list;
  }

  // Asks the function at the middles of the leaf's would-be branches.
  void ask(size_t index) {
    Leaf& leaf = leaves_[index];
    tree_.nodes_[leaf.node].value = 0;
    leaf.error = leaf.sum = 0;
    if (rank_ == 3 && leaf.level && leaf.place[0] >> (leaf.level - 1)) return;
    std::vector<double> f(function_.info().wavelength_um.size());
    std::array<double, 16> value, weight;
    const double width = std::ldexp(1.0, -leaf.level);
    double mean = 0, error = 0, sum = 0;
    for (size_t b = 0; b < branches_; ++b) {
      tensor::Point p{};
      for (size_t i = 0; i < rank_; ++i) p[i] = (leaf.place[i] + (b >> i & 1 ? 0.75 : 0.25)) * width;
      const auto [out, in] = tensor::directions(p, rank_);
      function_.value(out, in, f);
      value[b] = f[channel_] > 0 ? f[channel_] : 0;  // nan: no data
      // Equal volumes are equal projected solid angles of both (rank 3: but for the sine), and the measure is that of
      // `in` and the solid angle of `out`.
      weight[b] = (rank_ == 3 ? std::hypot(in.x, in.y) : 1) / std::max(out.z, kGrazing) *
                  (std::min(out.z, in.z) < kGrazing ? kBeyond : 1);
      mean += value[b] / static_cast<double>(branches_);
    }
    for (size_t b = 0; b < branches_; ++b) error += weight[b] * std::fabs(value[b] - mean), sum += weight[b] * value[b];
    const double volume = std::pow(0.5 * width, static_cast<double>(rank_));
    leaf.error = static_cast<float>(error * volume), leaf.sum = static_cast<float>(sum * volume);
    tree_.nodes_[leaf.node].value = written(mean);
  }

  // Cuts leaves; false: there were none.
  bool split(const std::vector<size_t>& cut) {
    for (const size_t index : cut) {
      const Leaf parent = leaves_[index];
      const auto first = static_cast<uint32_t>(tree_.nodes_.size());
      tree_.nodes_[parent.node].branches = first;
      tree_.nodes_.resize(tree_.nodes_.size() + branches_);
      for (size_t b = 0; b < branches_; ++b) {
        Leaf leaf;
        leaf.node = first + static_cast<uint32_t>(b);
        leaf.level = static_cast<uint8_t>(parent.level + 1);
        for (size_t i = 0; i < rank_; ++i) leaf.place[i] = static_cast<uint16_t>(2 * parent.place[i] + (b >> i & 1));
        if (b)
          leaves_.push_back(leaf);
        else
          leaves_[index] = leaf;  // the first branch takes its parent's place
      }
    }
    const size_t fresh = leaves_.size() - cut.size() * (branches_ - 1);
    parallel_for(0, cut.size() * branches_, 64, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) ask(i < cut.size() ? cut[i] : fresh + i - cut.size());
    });
    return !cut.empty();
  }

  // The leaves to cut next: those with at least half of the largest error, no more than it takes to reach the aim when
  // each cut halves its error, no more than there may be.
  std::vector<size_t> worst(const TensorTree::Aim& aim) const {
    float largest = 0;
    for (const Leaf& leaf : leaves_)
      if (leaf.level < kMostLevels) largest = std::max(largest, leaf.error);
    const double excess = left() - aim.error * sum();
    std::vector<size_t> list;
    if (excess <= 0 || largest == 0) return list;
    for (size_t i = 0; i < leaves_.size(); ++i)
      if (leaves_[i].level < kMostLevels && leaves_[i].error >= 0.5F * largest) list.push_back(i);
    std::stable_sort(list.begin(), list.end(), [&](size_t a, size_t b) { return leaves_[a].error > leaves_[b].error; });
    const size_t room = aim.leaves > leaves_.size() ? (aim.leaves - leaves_.size()) / (branches_ - 1) : 0;
    size_t n = 0;
    for (double gain = 0; n < std::min(room, list.size()) && gain < excess; ++n) gain += 0.5 * leaves_[list[n]].error;
    list.resize(n);
    return list;
  }

  // Makes a node whose branches are leaves one, where that adds at most `error`. Volumes as of ask(), weights of the
  // node's middle.
  void merge(uint32_t node, const Leaf& at, double error) {
    const uint32_t first = tree_.nodes_[node].branches;
    if (!first) return;
    bool leaves = true;
    double mean = 0;
    for (size_t b = 0; b < branches_; ++b) {
      Leaf below;
      below.level = static_cast<uint8_t>(at.level + 1);
      for (size_t i = 0; i < rank_; ++i) below.place[i] = static_cast<uint16_t>(2 * at.place[i] + (b >> i & 1));
      merge(first + static_cast<uint32_t>(b), below, error);
      leaves = leaves && !tree_.nodes_[first + b].branches;
      mean += tree_.nodes_[first + b].value / static_cast<double>(branches_);
    }
    if (!leaves) return;
    const double width = std::ldexp(1.0, -at.level);
    tensor::Point p{};
    for (size_t i = 0; i < rank_; ++i) p[i] = (at.place[i] + 0.5) * width;
    const auto [out, in] = tensor::directions(p, rank_);
    const double weight = std::pow(0.5 * width, static_cast<double>(rank_)) / std::max(out.z, kGrazing);
    double more = 0;
    for (size_t b = 0; b < branches_; ++b) more += weight * std::fabs(tree_.nodes_[first + b].value - mean);
    if (more <= error) tree_.nodes_[node] = {0, written(mean)};
  }

  // Leaves out the nodes that merging has cut off.
  void compact() {
    std::vector<TensorTree::Node> kept(1, tree_.nodes_[0]);
    std::vector<int> level(1, 0);
    for (size_t i = 0; i < kept.size(); ++i) {
      const uint32_t from = kept[i].branches;
      if (!from) {
        ++tree_.leaves_;
        tree_.levels_ = std::max(tree_.levels_, level[i]);
        continue;
      }
      kept[i].branches = static_cast<uint32_t>(kept.size());
      for (size_t b = 0; b < branches_; ++b) kept.push_back(tree_.nodes_[from + b]), level.push_back(level[i] + 1);
    }
    tree_.nodes_ = std::move(kept);
  }

  TensorTree& tree_;
  const sqt::Function& function_;
  size_t channel_, rank_, branches_;
  std::vector<Leaf> leaves_;
};

TensorTree::TensorTree(const sqt::Function& function, size_t channel, const Aim& aim)
    : info_(function.info()), rank_(info_.isotropic ? 3 : 4) {
  if (info_.domain != sqt::Domain::hemisphere || info_.quantity != sqt::Quantity::bsdf)
    throw Error("'" + info_.name + "' is no BRDF over the hemisphere: a tensor tree is written of nothing else",
                "write .csv");
  SUITE_CHECK(aim.error > 0 && aim.leaves > 0 && aim.leaves <= kMostLeaves);
  info_.wavelength_um = {info_.wavelength_um.at(channel)};
  info_.channel_names.clear();
  TensorTreeBuilder(*this, function, channel).build(aim);
}

void TensorTree::value(Dir out, Dir in, std::span<double> f) const {
  f[0] = 0;
  if (!(out.z > 0 && in.z > 0)) return;
  tensor::Point p = tensor::point_of(out, in, rank_);
  size_t node = 0;
  while (nodes_[node].branches) {
    size_t branch = 0;
    for (size_t i = 0; i < rank_; ++i) {
      const bool upper = p[i] >= 0.5;
      branch |= static_cast<size_t>(upper) << i;
      p[i] = 2 * p[i] - (upper ? 1 : 0);
    }
    node = nodes_[node].branches + branch;
  }
  f[0] = nodes_[node].value;
}

}  // namespace suite
