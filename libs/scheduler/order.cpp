#include "scheduler/order.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>

namespace suite {

namespace {

size_t cost(const StatePair& a, const StatePair& b) { return (a.window != b.window) + (a.spectral != b.spectral); }

// Held & Karp 1962: best[set][last] over sets of visited pairs.
std::vector<size_t> exact_order(std::span<const StatePair> pairs) {
  const size_t n = pairs.size(), sets = size_t{1} << n;
  constexpr uint16_t never = 0xffff;
  std::vector<uint16_t> best(sets * n, never);
  std::vector<uint8_t> from(sets * n, 0);
  for (size_t i = 0; i < n; ++i) best[(size_t{1} << i) * n + i] = 0;
  for (size_t set = 1; set < sets; ++set)
    for (size_t last = 0; last < n; ++last) {
      const uint16_t here = best[set * n + last];
      if (here == never) continue;
      for (size_t next = 0; next < n; ++next) {
        if (set >> next & 1) continue;
        const size_t grown = (set | size_t{1} << next) * n + next;
        const auto there = static_cast<uint16_t>(here + cost(pairs[last], pairs[next]));
        if (there < best[grown]) best[grown] = there, from[grown] = static_cast<uint8_t>(last);
      }
    }
  size_t set = sets - 1, last = 0;
  for (size_t i = 1; i < n; ++i)
    if (best[set * n + i] < best[set * n + last]) last = i;
  std::vector<size_t> order(n);
  for (size_t k = n; k-- > 0;) {
    order[k] = last;
    const size_t before = from[set * n + last];
    set &= ~(size_t{1} << last);
    last = before;
  }
  return order;
}

// Windows in turn; inside each, its states, beginning with the one that is up already and ending, where there is a
// choice, with one that the next window needs too.
std::vector<size_t> swept_order(std::span<const StatePair> pairs) {
  std::map<size_t, std::vector<size_t>> of_window;
  for (size_t i = 0; i < pairs.size(); ++i) of_window[pairs[i].window].push_back(i);
  std::vector<std::vector<size_t>> groups;
  for (auto& [window, members] : of_window) groups.push_back(std::move(members));
  auto has = [&](auto& group, size_t state) {
    return std::find_if(group.begin(), group.end(), [&](size_t i) { return pairs[i].spectral == state; });
  };
  std::vector<size_t> order;
  for (size_t g = 0; g < groups.size(); ++g) {
    if (!order.empty()) {
      // The next window is one that needs the state that is up, the one with the fewest states of its own first.
      const size_t up = pairs[order.back()].spectral;
      size_t best = g;
      for (size_t c = g; c < groups.size(); ++c) {
        const bool fits = has(groups[c], up) != groups[c].end(),
                   best_fits = has(groups[best], up) != groups[best].end();
        if (fits != best_fits ? fits : groups[c].size() < groups[best].size()) best = c;
      }
      std::swap(groups[g], groups[best]);
    }
    std::vector<size_t>& group = groups[g];
    if (!order.empty())
      if (const auto up = has(group, pairs[order.back()].spectral); up != group.end())
        std::iter_swap(group.begin(), up);
    // Leave on a state that most of the windows to come want.
    auto wanted = [&](size_t i) {
      size_t count = 0;
      for (size_t c = g + 1; c < groups.size(); ++c) count += has(groups[c], pairs[i].spectral) != groups[c].end();
      return count;
    };
    if (group.size() > 2 || (group.size() == 2 && order.empty())) {
      const auto last = std::max_element(group.begin() + (order.empty() ? 0 : 1), group.end(),
                                         [&](size_t a, size_t b) { return wanted(a) < wanted(b); });
      std::iter_swap(group.end() - 1, last);
    }
    order.insert(order.end(), group.begin(), group.end());
  }
  return order;
}

// Reverses stretches for as long as that removes a change (2-opt; Croes 1958).
void improve(std::span<const StatePair> pairs, std::vector<size_t>& order) {
  const size_t n = order.size();
  auto between = [&](size_t a, size_t b) { return cost(pairs[order[a]], pairs[order[b]]); };
  for (bool better = true; better;) {
    better = false;
    for (size_t i = 0; i < n; ++i)
      for (size_t k = i + 1; k < n; ++k) {
        const size_t old = (i ? between(i - 1, i) : 0) + (k + 1 < n ? between(k, k + 1) : 0);
        const size_t now = (i ? between(i - 1, k) : 0) + (k + 1 < n ? between(i, k + 1) : 0);
        if (now >= old) continue;
        std::reverse(order.begin() + static_cast<long>(i), order.begin() + static_cast<long>(k) + 1);
        better = true;
      }
  }
}

}  // namespace

size_t state_changes(std::span<const StatePair> sequence) {
  size_t changes = 0;
  for (size_t i = 1; i < sequence.size(); ++i) changes += cost(sequence[i - 1], sequence[i]);
  return changes;
}

std::vector<size_t> cheapest_order(std::span<const StatePair> work) {
  std::vector<StatePair> distinct;
  std::map<std::pair<size_t, size_t>, size_t> index;
  std::vector<std::vector<size_t>> members;
  for (size_t i = 0; i < work.size(); ++i) {
    const auto [place, fresh] = index.try_emplace({work[i].window, work[i].spectral}, distinct.size());
    if (fresh) distinct.push_back(work[i]), members.emplace_back();
    members[place->second].push_back(i);
  }
  std::vector<size_t> order;
  if (distinct.size() <= 12) {
    if (!distinct.empty()) order = exact_order(distinct);
  } else {
    order = swept_order(distinct);
    // Quadratic in the number of pairs: worth it while pairs are few; thousands of windows are swept well already.
    if (distinct.size() <= 512) improve(distinct, order);
  }
  std::vector<size_t> all;
  for (const size_t d : order) all.insert(all.end(), members[d].begin(), members[d].end());
  return all;
}

}  // namespace suite
