#include "dry_checks.h"

#include <algorithm>
#include <set>

#include "estimate/budget.h"
#include "guard.h"
#include "heat/seen_warmth.h"
#include "scheduler/items.h"
#include "scheduler/primed.h"
#include "surface/cut_out.h"

namespace suite {

namespace {

// What all captures of a job share here, one after the other.
struct Primer {
  const std::shared_ptr<const Scene>& scene;
  JobOptions options;
  bool moves;
  Kits kits;
  StateNumbers numbers;
  std::shared_ptr<const Tracer> tracer;
  TimeSpan of{};

  Primer(const std::shared_ptr<const Scene>& s, const Simulation& sim, const JobOptions& o, TimeSpan window)
      : scene(s),
        options(o),
        moves(changes_in_time(*s)),
        kits(*s, sim.sources, sim.periodic.has_value(), window, o.kit_bytes, {.pending = waits_for_heat(*s)}) {
    options.pipeline.gloss_photons = 0;  // they would be traced
  }
  // Under a limit, however large, nothing is built before a ray comes.
  void turn_to(const TimeWindow& window) {
    const TimeSpan span{window.begin, window.end};
    if (tracer && (!moves || span == of)) return;
    tracer = std::make_shared<const Tracer>(scene, options.periodic, span, cut_out(*scene), TileLimit{SIZE_MAX, {}});
    of = span;
  }
  void prime(const Sensor& sensor, const Capture& capture) {
    const size_t state = numbers.of(sensor.states()[capture.state]);
    kits.expect(state);
    Kit kit = kits.get(state, sensor, capture, tracer);
    check_many_suns(sensor, capture, kit);
    const Primed primed(tracer, std::move(kit), sensor, capture.state, options.pipeline);
    kits.done(state);
  }
  void check(const Sensor& sensor) {
    std::set<size_t> states;
    for (const Task& task : sensor.tasks())
      for (const Capture& c : task.captures) {
        check_temperatures(*scene, c.window.begin, c.window.end);
        goals_of(sensor, c, options.budget);
        turn_to(c.window);
        if (states.insert(c.state).second) prime(sensor, c);
      }
  }
};

}  // namespace

void check_captures(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& options) {
  TimeSpan window{kEver, -kEver};
  for (const auto& sensor : sim.sensors)
    for (const Task& task : sensor->tasks())
      for (const Capture& c : task.captures) window = hull(window, c.window);
  Primer primer(scene, sim, options, window);
  for (size_t s = 0; s < sim.sensors.size(); ++s) {
    try {
      primer.check(*sim.sensors[s]);
    } catch (const Error& e) {
      throw located(e, *scene, sim, s);
    }
  }
}

Error located_in_captures(const Error& fault, const std::shared_ptr<const Scene>& scene, const Simulation& sim,
                          const JobOptions& options) {
  if (!fault.where().file.empty()) return fault;
  try {
    check_captures(scene, sim, options);
  } catch (const Error& e) {
    return e;
  }
  return located(fault, *scene, sim);
}

}  // namespace suite
