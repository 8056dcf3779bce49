// The order in which work is done, so that the scene's temporal state and the materials' spectral state change as
// seldom as possible (paper, section III-C: states are what the core is primed for).
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace suite {

// What one capture needs: equal numbers mean that nothing has to be rebuilt.
struct StatePair {
  size_t window = 0, spectral = 0;
  bool operator==(const StatePair&) const = default;
};

// Changes along a sequence: one for a change of either, two when both change at once; the first pair costs nothing.
size_t state_changes(std::span<const StatePair> sequence);

// A permutation of [0, work.size()) with few state changes; equal pairs keep their order. With d distinct pairs at
// least d - 1 changes are needed, and one more for each place where neighbours share neither. Exact (dynamic
// programming over subsets) up to 12 distinct pairs; above, chains are grown greedily and improved by reversals, which
// reaches the bound whenever windows and states are crossed completely or one of the two does not change.
std::vector<size_t> cheapest_order(std::span<const StatePair> work);

}  // namespace suite
