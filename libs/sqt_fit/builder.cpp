// Filling and reducing one tree; see paper_fit.h.
#include <algorithm>
#include <cmath>

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

std::vector<PaperLeaf> Builder::reduce(double threshold) const {
  // Average: one value per cell of the full partition.
  std::vector<double> value(sum_.size());
  std::vector<uint8_t> state(sum_.size(), kAbsent);
  negative_ = 0;
  for (size_t i = 0; i < sum_.size(); ++i)
    if (count_[i]) {
      value[i] = sum_[i] / count_[i];
      if (value[i] < 0) ++negative_, value[i] = 0;
      state[i] = kLeaf;
    }
  double level = 0, weight = 0;
  for (size_t i = 0; i < sum_.size(); ++i)
    if (count_[i]) level += value[i], weight += 1;
  level = weight > 0 ? level / weight : 0;
  std::vector<std::vector<uint8_t>> states(static_cast<size_t>(order_) + 1);
  std::vector<std::vector<double>> values(static_cast<size_t>(order_) + 1);
  states[static_cast<size_t>(order_)] = std::move(state);
  values[static_cast<size_t>(order_)] = std::move(value);
  auto outside = [&](CellId id) { return domain_ == Domain::hemisphere && below_horizon(id); };

  // From the finest order upwards: a parent with an empty child takes its children in; a family of similar leaves too.
  for (int order = order_ - 1; order >= 0; --order) {
    const auto& below = states[static_cast<size_t>(order) + 1];
    const auto& below_value = values[static_cast<size_t>(order) + 1];
    auto& here = states[static_cast<size_t>(order)];
    auto& here_value = values[static_cast<size_t>(order)];
    here.assign(cell_count(order), kAbsent);
    here_value.assign(cell_count(order), 0);
    for (uint32_t p = 0; p < cell_count(order); ++p) {
      int leaves = 0, splits = 0, needed = 0;
      double low = INFINITY, high = -INFINITY, sum = 0;
      for (uint32_t k = 0; k < 4; ++k) {
        const uint32_t c = 4 * p + k;
        if (outside(CellId::of(order + 1, c))) continue;
        ++needed;
        if (below[c] == kSplit) ++splits;
        if (below[c] != kLeaf) continue;
        ++leaves;
        low = std::min(low, below_value[c]), high = std::max(high, below_value[c]), sum += below_value[c];
      }
      if (leaves + splits == 0) continue;
      const double mean = leaves ? sum / leaves : 0;
      const bool empty_child = leaves + splits < needed && splits == 0;
      const bool similar = splits == 0 && leaves == needed && high - low <= threshold * level;
      if (empty_child || similar) {
        here[p] = kLeaf;
        here_value[p] = mean;
        for (uint32_t k = 0; k < 4; ++k) states[static_cast<size_t>(order) + 1][4 * p + k] = kAbsent;
        continue;
      }
      here[p] = kSplit;
      if (leaves + splits == needed) continue;
      // Some child is split, another empty: the empty one takes the mean of its siblings that are leaves, or of all
      // leaves below the split ones; there is no smaller partition in which it could be left out.
      double total = sum;
      int n = leaves;
      if (!n)
        for (uint32_t k = 0; k < 4; ++k)
          if (below[4 * p + k] == kSplit) total += below_value[4 * p + k], ++n;
      for (uint32_t k = 0; k < 4; ++k) {
        const uint32_t c = 4 * p + k;
        if (below[c] == kAbsent && !outside(CellId::of(order + 1, c))) {
          states[static_cast<size_t>(order) + 1][c] = kLeaf;
          values[static_cast<size_t>(order) + 1][c] = total / n;
        }
      }
    }
    // The value of a split cell is the mean below it, for the rule above.
    for (uint32_t p = 0; p < cell_count(order); ++p)
      if (here[p] == kSplit) {
        int n = 0;
        for (uint32_t k = 0; k < 4; ++k)
          if (states[static_cast<size_t>(order) + 1][4 * p + k] != kAbsent)
            here_value[p] += below_value[4 * p + k], ++n;
        here_value[p] /= n;
      }
  }
  // Faces nobody measured are zero.
  for (uint32_t f = 0; f < 12; ++f)
    if (states[0][f] == kAbsent && !outside(CellId::of(0, f))) states[0][f] = kLeaf;
  std::vector<PaperLeaf> leaves;
  for (int order = 0; order <= order_; ++order)
    for (uint32_t i = 0; i < cell_count(order); ++i)
      if (states[static_cast<size_t>(order)][i] == kLeaf)
        leaves.push_back({CellId::of(order, i), static_cast<float>(values[static_cast<size_t>(order)][i])});
  // Depth-first order: neighbours in the file are neighbours on the sphere.
  std::sort(leaves.begin(), leaves.end(), [](const PaperLeaf& a, const PaperLeaf& b) {
    return a.id.index() << (2 * (kMaxOrder - a.id.order())) < b.id.index() << (2 * (kMaxOrder - b.id.order()));
  });
  return leaves;
}

}  // namespace suite::sqt
