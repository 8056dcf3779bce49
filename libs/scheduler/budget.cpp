#include "scheduler/budget.h"

#include <algorithm>
#include <limits>

namespace suite {

Convergence goal_of(const Capture& capture, const Budget& budget) {
  Convergence goal = capture.convergence;
  const bool fixed = goal.relative_error == 0 || goal.min_paths == goal.max_paths;
  if (budget.relative_error) goal.relative_error = *budget.relative_error;
  if (budget.absolute_floor) goal.absolute_floor = *budget.absolute_floor;
  if (goal.relative_error > 0 && fixed && !budget.max_paths)
    goal.min_paths = std::min(goal.min_paths, kDefaultPilot), goal.max_paths = kDefaultMost;
  if (budget.min_paths) goal.min_paths = *budget.min_paths;
  if (budget.max_paths) goal.max_paths = *budget.max_paths;
  goal.min_paths = std::min(goal.min_paths, goal.max_paths);
  if (goal.min_paths == goal.max_paths) goal.relative_error = 0;
  const uint32_t room = std::numeric_limits<uint32_t>::max() / 2 - goal.max_paths;
  goal.max_paths += std::min(budget.more, room);
  if (goal.relative_error == 0) goal.min_paths = goal.max_paths;
  return goal;
}

}  // namespace suite
