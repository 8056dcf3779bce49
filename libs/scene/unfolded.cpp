#include "scene/unfolded.h"

namespace suite {

std::vector<double> unfolded(const std::vector<Group>& groups) {
  std::vector<double> counts(groups.size(), 0);
  for (size_t g = groups.size(); g-- > 0;)
    for (const Placement& p : groups[g].placements)
      counts[g] += 1 + (p.kind == TargetKind::group ? counts[p.target] : 0);
  return counts;
}

}  // namespace suite
