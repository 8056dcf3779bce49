// Filling and reducing one tree; see paper_fit.h.
#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "sqt_fit/paper_fit.h"

namespace suite::sqt {

namespace {
constexpr uint8_t kAbsent = 0, kLeaf = 1, kSplit = 2;

bool below_horizon(CellId id) {
  // The highest point of a cell is its corner with the smallest x + y only in the north; check all corners.
  for (int k = 0; k < 4; ++k)
    if (direction(point_in(id, {static_cast<double>(k & 1), static_cast<double>(k >> 1)})).z > 1e-12) return false;
  return true;
}
}  // namespace

Builder::Builder(int order, Domain domain)
    : order_(order), domain_(domain), sum_(cell_count(order)), count_(cell_count(order)) {
  SUITE_CHECK(order >= 0 && order <= 8);
}

void Builder::insert(Dir in, double value) {
  if (!std::isfinite(value) || (domain_ == Domain::hemisphere && in.z <= 0)) {
    ++rejected_;
    return;
  }
  const uint32_t cell = cell_of(in, order_).index();
  sum_[cell] += value;
  ++count_[cell];
}

namespace {

// The cells of all orders, each absent, a leaf with a value, or split.
class Pyramid {
 public:
  // outside: whether a cell does not count.
  Pyramid(int order, std::function<bool(CellId)> outside)
      : states_(static_cast<size_t>(order) + 1), values_(states_.size()), outside_(std::move(outside)) {
    for (size_t o = 0; o < states_.size(); ++o) {
      states_[o].assign(cell_count(static_cast<int>(o)), kAbsent);
      values_[o].assign(states_[o].size(), 0);
    }
  }
  void set_leaf(size_t order, size_t cell, double value) { states_[order][cell] = kLeaf, values_[order][cell] = value; }
  // From the level below: a parent with an empty child takes its children in; a family that differs by `similar` at
  // most too.
  void take_in(int order, double similar) {
    for (uint32_t p = 0; p < cell_count(order); ++p) take_in(static_cast<size_t>(order), p, similar);
    // The value of a split cell is the mean below it, for the rule about empty children.
    auto& here = values_[static_cast<size_t>(order)];
    const auto& below = states_[static_cast<size_t>(order) + 1];
    for (uint32_t p = 0; p < cell_count(order); ++p)
      if (states_[static_cast<size_t>(order)][p] == kSplit) {
        int n = 0;
        for (uint32_t c = 4 * p; c < 4 * p + 4; ++c)
          if (below[c] != kAbsent) here[p] += values_[static_cast<size_t>(order) + 1][c], ++n;
        here[p] /= n;
      }
  }
  // Depth-first: neighbours in the file are neighbours on the sphere.
  std::vector<PaperLeaf> leaves() const {
    std::vector<PaperLeaf> leaves;
    for (size_t order = 0; order < states_.size(); ++order)
      for (uint32_t i = 0; i < states_[order].size(); ++i)
        if (states_[order][i] == kLeaf)
          leaves.push_back({CellId::of(static_cast<int>(order), i), static_cast<float>(values_[order][i])});
    std::sort(leaves.begin(), leaves.end(), [](const PaperLeaf& a, const PaperLeaf& b) {
      return a.id.index() << (2 * (kMaxOrder - a.id.order())) < b.id.index() << (2 * (kMaxOrder - b.id.order()));
    });
    return leaves;
  }
  // Faces nobody measured are zero.
  void fill_faces() {
    for (uint32_t f = 0; f < 12; ++f)
      if (states_[0][f] == kAbsent && !outside_(CellId::of(0, f))) states_[0][f] = kLeaf;
  }

 private:
  void take_in(size_t order, uint32_t p, double similar) {
    auto& below = states_[order + 1];
    const auto& value = values_[order + 1];
    const auto is_outside = [&](uint32_t c) { return outside_(CellId::of(static_cast<int>(order) + 1, c)); };
    int leaves = 0, splits = 0, needed = 0;
    double low = INFINITY, high = -INFINITY, sum = 0;
    for (uint32_t c = 4 * p; c < 4 * p + 4; ++c) {
      if (is_outside(c)) continue;
      ++needed;
      if (below[c] == kSplit) ++splits;
      if (below[c] != kLeaf) continue;
      ++leaves;
      low = std::min(low, value[c]), high = std::max(high, value[c]), sum += value[c];
    }
    if (leaves + splits == 0) return;
    const bool empty_child = leaves + splits < needed && splits == 0;
    if (empty_child || (splits == 0 && leaves == needed && high - low <= similar)) {
      set_leaf(order, p, leaves ? sum / leaves : 0);
      for (uint32_t c = 4 * p; c < 4 * p + 4; ++c) below[c] = kAbsent;
      return;
    }
    states_[order][p] = kSplit;
    if (leaves + splits == needed) return;
    // Some child is split, another empty: the empty one takes the mean of its siblings that are leaves, or of all
    // leaves below the split ones; there is no smaller partition in which it could be left out.
    double total = sum;
    int n = leaves;
    if (!n)
      for (uint32_t c = 4 * p; c < 4 * p + 4; ++c)
        if (below[c] == kSplit) total += value[c], ++n;
    for (uint32_t c = 4 * p; c < 4 * p + 4; ++c)
      if (below[c] == kAbsent && !is_outside(c)) set_leaf(order + 1, c, total / n);
  }
  std::vector<std::vector<uint8_t>> states_;  // [order][cell]
  std::vector<std::vector<double>> values_;
  std::function<bool(CellId)> outside_;
};

}  // namespace

std::vector<PaperLeaf> Builder::reduce(double threshold) const {
  Pyramid pyramid(order_, [this](CellId id) { return domain_ == Domain::hemisphere && below_horizon(id); });
  // One value per cell of the full partition; the mean of all.
  negative_ = 0;
  double level = 0, weight = 0;
  for (size_t i = 0; i < sum_.size(); ++i) {
    if (!count_[i]) continue;
    double value = sum_[i] / count_[i];
    if (value < 0) ++negative_, value = 0;
    pyramid.set_leaf(static_cast<size_t>(order_), i, value);
    level += value, weight += 1;
  }
  level = weight > 0 ? level / weight : 0;
  for (int order = order_ - 1; order >= 0; --order) pyramid.take_in(order, threshold * level);
  pyramid.fill_faces();
  return pyramid.leaves();
}

}  // namespace suite::sqt
