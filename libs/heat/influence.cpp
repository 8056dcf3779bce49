#include "heat/influence.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"

namespace suite {

namespace {

constexpr int kReach = 12;         // reflections and surfaces between what is seen and what matters
constexpr int kTurns = 2000;       // of the iteration
constexpr double kSettled = 1e-7;  // K

double fourth(double kelvin) { return kelvin * kelvin * kelvin * kelvin; }

}  // namespace

Influence::Influence(const ExchangePaths& exchange, const HeatFaces& faces, double hottest)
    : exchange_(exchange),
      faces_(faces),
      outsides_(faces.outsides()),
      hottest_(hottest),
      matrix_(exchange.matrix(faces.outsides())) {
  SUITE_CHECK_EQ(exchange.faces(), faces.size());
  for (size_t f = 0; f < faces.size(); ++f) {
    element_.push_back(faces.element(f));
    elements_ = std::max<size_t>(elements_, element_.back() + size_t{1});
  }
}

// By element, the largest product of shares along a chain of paths from what is seen: an order to leave out in.
std::vector<double> Influence::importance(const std::vector<bool>& seen) const {
  const size_t n = exchange_.faces(), each = size_t{exchange_.blocks} * exchange_.paths;
  std::vector<double> v(elements_);
  for (size_t e = 0; e < elements_; ++e) v[e] = seen[e] ? 1 : 0;
  for (int turn = 0; turn < kReach; ++turn) {
    std::vector<double> next = v;
    for (size_t f = 0; f < n; ++f) {
      double sum = 0;
      for (size_t k = f * each; k < (f + 1) * each; ++k) sum += double{exchange_.weights[k]};
      const double own = exchange_.area[f] * exchange_.emissivity[f];
      for (size_t k = f * each; k < (f + 1) * each && sum > 0; ++k) {
        const uint32_t end = exchange_.ends[k], face = faces_.face_of(end);
        if (face == kNone) continue;
        // A path tells of both ends: what one gives the other, that takes. Closed backs take nothing.
        const double share = double{exchange_.weights[k]} / sum,
                     other = end == face ? exchange_.area[face] * exchange_.emissivity[face] : 0;
        double &mine = next[element_[f]], &theirs = next[element_[face]];
        theirs = std::max(theirs, v[element_[f]] * share);
        if (other > 0) mine = std::max(mine, v[element_[face]] * std::min(1.0, share * own / other));
      }
    }
    v = std::move(next);
  }
  return v;
}

double Influence::off_at_most(const std::vector<bool>& seen, const std::vector<bool>& kept, const Range& range,
                              std::array<double, 2> air) const {
  const size_t n = exchange_.faces();
  const double dropped = std::max(fourth(hottest_) - fourth(air[0]), fourth(air[1]));
  std::vector<double> off(elements_, 0.0), emitted(n + outsides_, 0.0), received(n), next(elements_);
  for (int turn = 0; turn < kTurns; ++turn) {
    for (size_t f = 0; f < n; ++f) {
      const double T = range.high[f], d = off[element_[f]];
      emitted[f] = kept[element_[f]] ? fourth(T + d) - fourth(T) : dropped;
    }
    matrix_.receive(emitted, 1, received);
    std::fill(next.begin(), next.end(), 0.0);
    for (size_t f = 0; f < n; ++f) {
      if (!kept[element_[f]]) continue;
      const double left = fourth(range.low[f]) - received[f];
      const double d = left > 0 ? range.low[f] - std::sqrt(std::sqrt(left)) : hottest_;
      next[element_[f]] = std::max(next[element_[f]], std::min(d, hottest_));
    }
    double change = 0;
    for (size_t e = 0; e < elements_; ++e) change = std::max(change, std::fabs(next[e] - off[e]));
    off.swap(next);
    if (change < kSettled) {
      double worst = 0;
      for (size_t e = 0; e < elements_; ++e)
        if (seen[e]) worst = std::max(worst, kept[e] ? off[e] : hottest_);
      return worst;
    }
  }
  return hottest_;
}

std::vector<bool> Influence::kept_for(const std::vector<bool>& seen, double limit, double kelvin) const {
  constexpr double kFirst = 2;  // more than any product of shares: also what is not seen may reach 1
  std::vector<double> matters = importance(seen);
  for (size_t e = 0; e < elements_; ++e)
    if (seen[e]) matters[e] = kFirst;
  std::vector<uint32_t> order(elements_);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return matters[a] > matters[b]; });
  const Range near{std::vector<double>(exchange_.faces(), kelvin), std::vector<double>(exchange_.faces(), kelvin)};
  const auto first = [&](size_t count) {
    std::vector<bool> kept(elements_, false);
    for (size_t k = 0; k < count; ++k) kept[order[k]] = true;
    return kept;
  };
  // The fewest that are enough: more are never worse.
  size_t low = static_cast<size_t>(std::count(seen.begin(), seen.end(), true)), high = elements_;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (off_at_most(seen, first(middle), near, {kelvin, kelvin}) <= limit)
      high = middle;
    else
      low = middle + 1;
  }
  return first(high);
}

ExchangePaths left_of(const ExchangePaths& exchange, const HeatFaces& all, const HeatFaces& left,
                      const std::vector<bool>& kept) {
  const size_t each = size_t{exchange.blocks} * exchange.paths;
  std::vector<uint32_t> number(exchange.faces(), kNone);
  uint32_t count = 0;
  for (size_t f = 0; f < exchange.faces(); ++f)
    if (kept[all.element(f)]) number[f] = count++;
  SUITE_CHECK_EQ(size_t{count}, left.size());
  const auto faces = static_cast<uint32_t>(exchange.faces());
  const auto end_of = [&](uint32_t end) {
    const uint32_t face = all.face_of(end);
    if (face == kNone) return end - faces + count;
    if (number[face] == kNone) return left.outside_moving();
    return end == face ? number[face] : left.closed_back(left.element(number[face]));
  };
  ExchangePaths out;
  SUITE_CHECK(exchange.rows.intervals == 1);
  out.blocks = exchange.blocks, out.paths = exchange.paths, out.count = exchange.count;
  out.rows.faces = count, out.presence.emplace_back();
  for (size_t f = 0; f < exchange.faces(); ++f) {
    if (number[f] == kNone) continue;
    out.emissivity.push_back(exchange.emissivity[f]), out.area.push_back(exchange.area[f]);
    if (const auto& there = exchange.presence.front(); !there.empty()) out.presence.front().push_back(there[f]);
    for (size_t k = f * each; k < (f + 1) * each; ++k) {
      out.weights.push_back(exchange.weights[k]);
      out.ends.push_back(end_of(exchange.ends[k]));
    }
  }
  return out;
}

}  // namespace suite
