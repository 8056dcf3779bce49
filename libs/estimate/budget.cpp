#include "estimate/budget.h"

#include <algorithm>
#include <limits>

#include "base/error.h"

namespace suite {

Convergence goal_of(const Convergence& asked, const Budget& budget) {
  Convergence goal = asked;
  const bool fixed = goal.relative_error == 0 || goal.min_paths == goal.max_paths;
  if (budget.relative_error) goal.relative_error = *budget.relative_error;
  if (budget.absolute_floor) goal.absolute_floor = *budget.absolute_floor;
  // A fixed count that is given a target on top has no say in how many paths that may take.
  if (budget.relative_error && goal.relative_error > 0 && fixed && !budget.max_paths)
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

Convergence Goals::of(size_t problem) const {
  if (own.empty()) return all;
  Convergence goal = own[problem];
  goal.max_paths = std::min(goal.max_paths, all.max_paths);
  goal.min_paths = std::min(goal.min_paths, goal.max_paths);
  return goal;
}

Goals goals_of(const Sensor& sensor, const Capture& capture, const Budget& budget) {
  Goals goals{goal_of(capture, budget), {}};
  if (!capture.own_convergence || capture.problems() == 0) return goals;
  goals.own.reserve(capture.problems());
  for (size_t i = 0; i < capture.problems(); ++i) {
    const Convergence asked = sensor.convergence(capture, i);
    if (asked.min_paths < 1 || asked.max_paths < asked.min_paths || !(asked.relative_error >= 0) ||
        !(asked.absolute_floor >= 0))
      throw Error(
          strf("sensor '%s' asks for %u to %u paths and a relative error of %g for problem %zu of capture '%s'",
               sensor.name().c_str(), asked.min_paths, asked.max_paths, asked.relative_error, i, capture.name.c_str()),
          "at least one path, a maximum not below the minimum, and no negative target");
    const Convergence goal = goal_of(asked, budget);
    goals.own.push_back(goal);
    if (i == 0) goals.all = goal;
    goals.all.min_paths = std::min(goals.all.min_paths, goal.min_paths);
    goals.all.max_paths = std::max(goals.all.max_paths, goal.max_paths);
    if (goal.relative_error > 0)
      goals.all.relative_error =
          goals.all.relative_error > 0 ? std::min(goals.all.relative_error, goal.relative_error) : goal.relative_error;
  }
  return goals;
}

}  // namespace suite
