// The order of captures changes states as seldom as any order could.
#include "scheduler/order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "math/sampling.h"

namespace suite::order_test {
namespace {

std::vector<StatePair> in_order(const std::vector<StatePair>& work, const std::vector<size_t>& order) {
  std::vector<StatePair> sequence;
  for (const size_t i : order) sequence.push_back(work[i]);
  return sequence;
}

// The least changes of any order of the distinct pairs, by trying all of them.
size_t brute_force(const std::vector<StatePair>& work) {
  std::set<std::pair<size_t, size_t>> distinct;
  for (const StatePair& p : work) distinct.insert({p.window, p.spectral});
  std::vector<std::pair<size_t, size_t>> order(distinct.begin(), distinct.end());
  size_t best = SIZE_MAX;
  do {
    std::vector<StatePair> sequence;
    for (const auto& [w, s] : order) sequence.push_back({w, s});
    best = std::min(best, state_changes(sequence));
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(Order, three_sensors_four_states_fifty_captures_reach_the_brute_force_minimum) {
  Pcg32 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    // Each sensor has a state or two of the four; two windows move, so at most 8 distinct pairs.
    std::vector<StatePair> work;
    for (int c = 0; c < 50; ++c) {
      const size_t sensor = static_cast<size_t>(random.uniform() * 3);
      work.push_back(
          {static_cast<size_t>(random.uniform() * 2), (sensor + static_cast<size_t>(random.uniform() * 2)) % 4});
    }
    const std::vector<size_t> order = cheapest_order(work);
    std::vector<size_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i) << "every capture once";
    EXPECT_EQ(state_changes(in_order(work, order)), brute_force(work));
    EXPECT_GE(state_changes(work), brute_force(work));  // the order they came in is no better
  }
}

TEST(Order, a_static_scene_changes_each_spectral_state_once) {
  std::vector<StatePair> work;
  for (size_t c = 0; c < 5000; ++c) work.push_back({0, c % 4});
  EXPECT_EQ(state_changes(in_order(work, cheapest_order(work))), 3u);
}

TEST(Order, many_windows_crossed_with_states_cost_one_change_a_step) {
  std::vector<StatePair> work;
  for (size_t w = 0; w < 50; ++w)
    for (size_t s = 0; s < 4; ++s) work.push_back({w, s});
  EXPECT_EQ(state_changes(in_order(work, cheapest_order(work))), 199u);
}

TEST(Order, equal_pairs_keep_their_order_and_nothing_is_nothing) {
  const std::vector<StatePair> work{{0, 1}, {0, 0}, {0, 1}, {0, 0}, {0, 1}};
  const std::vector<size_t> order = cheapest_order(work);
  std::vector<size_t> ones, zeros;
  for (const size_t i : order) (work[i].spectral ? ones : zeros).push_back(i);
  EXPECT_EQ(ones, (std::vector<size_t>{0, 2, 4}));
  EXPECT_EQ(zeros, (std::vector<size_t>{1, 3}));
  EXPECT_TRUE(cheapest_order({}).empty());
}

}  // namespace
}  // namespace suite::order_test
