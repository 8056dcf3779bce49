// What a job will run and take, before it begins.
#include <algorithm>

#include "scheduler/forecast.h"
#include "scheduler/items.h"
#include "scheduler/scheduler.h"

namespace suite {

namespace {
// visit(sensor, capture, budget, mine) of all captures, pre-passes included. mine: [block] those of the share that is
// run; empty = all.
template <class Visit>
void for_captures(Sensors sensors, const JobOptions& options, const Visit& visit) {
  std::vector<std::vector<uint8_t>> shared;
  if (options.share) shared = blocks_of_share(sensors, *options.share);
  for (const Sensors all : {options.prepasses, sensors}) {
    size_t id = 0;
    for (const auto& s : all)
      for (const Task& t : s->tasks())
        for (const Capture& c : t.captures) {
          const bool own = all.data() == sensors.data();
          visit(*s, c, own ? options.budget : Budget{}, own && options.share ? shared[id] : std::vector<uint8_t>{});
          ++id;
        }
  }
}
}  // namespace

double forecast_paths(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  double sum = 0;
  for_captures(sensors, options,
               [&](const Sensor& s, const Capture& c, const Budget& budget, const std::vector<uint8_t>& mine) {
                 const Goals goals = goals_of(s, c, budget);
                 for (const Block& b : blocks_of(c))
                   for (size_t i = 0; (mine.empty() || mine[number_of(b, c.columns)]) && i < b.problems(); ++i) {
                     const Convergence goal = goals.of(problem_at(c, b, i));
                     sum += goal.relative_error > 0 ? goal.min_paths : goal.max_paths;
                   }
               });
  return sum;
}

bool paths_are_fixed(Sensors sensors, const JobOptions& options) {
  bool fixed = true;
  for_captures(sensors, options,
               [&](const Sensor& s, const Capture& c, const Budget& budget, const std::vector<uint8_t>&) {
                 const Goals goals = goals_of(s, c, budget);
                 fixed = fixed && !(goals.all.relative_error > 0) &&
                         std::ranges::none_of(goals.own, [](const Convergence& g) { return g.relative_error > 0; });
               });
  return fixed;
}

std::unique_ptr<Progress> begin_progress(Sensors sensors, const JobOptions& options, double spent) {
  TimeLeft::Bounds bounds;
  if (!paths_are_fixed(sensors, options)) bounds.total = TimeLeft::Total::least;
  if (options.budget.seconds > 0) bounds.seconds = options.budget.seconds - spent;
  return std::make_unique<Progress>("rendering", forecast_paths(sensors, options), "path", bounds);
}

double forecast_bytes(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  double most = 0;
  for_captures(sensors, options, [&](const Sensor& s, const Capture& c, const Budget& budget, const auto&) {
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
