// What a job will run and take, before it begins.
#include "scheduler/items.h"
#include "scheduler/scheduler.h"

namespace suite {

namespace {
// visit(sensor, capture, budget) of all captures, pre-passes included.
template <class Visit>
void for_captures(Sensors sensors, const JobOptions& options, const Visit& visit) {
  for (const Sensors all : {options.prepasses, sensors})
    for (const auto& s : all)
      for (const Task& t : s->tasks())
        for (const Capture& c : t.captures) visit(*s, c, all.data() == sensors.data() ? options.budget : Budget{});
}
}  // namespace

double forecast_paths(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  double sum = 0;
  for_captures(sensors, options, [&](const Sensor& s, const Capture& c, const Budget& budget) {
    const Goals goals = goals_of(s, c, budget);
    auto least = [](const Convergence& goal) {
      return static_cast<double>(goal.relative_error > 0 ? goal.min_paths : goal.max_paths);
    };
    if (goals.own.empty()) sum += static_cast<double>(c.problems()) * least(goals.all);
    for (const Convergence& goal : goals.own) sum += least(goal);
  });
  return sum;
}

double forecast_bytes(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  double most = 0;
  for_captures(sensors, options, [&](const Sensor& s, const Capture& c, const Budget& budget) {
    const size_t bands = s.bands(c.state).size();
    const Accumulators::Shape sums{c.problems(), bands, scrambles_for(goals_of(s, c, budget).all.max_paths)};
    const double result = static_cast<double>(c.problems()) * (24.0 * static_cast<double>(bands) + 200);
    most = std::max(most, static_cast<double>(sums.bytes()) + result);
  });
  return most;
}

JobOrder order_of(std::span<const std::unique_ptr<Sensor>> sensors, bool moves, bool dated) {
  JobOrder order;
  for (const Item& i : in_cheapest_order(items_of(sensors, moves), dated, order.state_changes))
    order.captures.push_back(i.id);
  return order;
}

}  // namespace suite
