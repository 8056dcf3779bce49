#include "dry_run.h"

#include <algorithm>
#include <cstdio>

#include "base/progress.h"
#include "dry_checks.h"
#include "facts.h"
#include "guard.h"
#include "heat.h"
#include "scheduler/features.h"
#include "scheduler/items.h"

namespace suite {

namespace {

// What the scene will take in memory.
void print_forecast(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& options) {
  const Sensor& first = *sim.sensors.front();
  const TimeWindow window = first.tasks().front().captures.front().window;
  // Under a limit, however large, nothing is built before a ray comes.
  const Tracer tracer(scene, options.periodic, {window.begin, window.end}, nullptr, {SIZE_MAX, {}});
  const TileForecast f = tracer.forecast();
  const auto text = [](uint64_t bytes) { return human_bytes(static_cast<double>(bytes)); };
  std::printf("%zu tiles of the scene take %s of geometry and some %s of the ray tracer's structures\n", f.tiles,
              text(f.geometry).c_str(), text(f.structures).c_str());
  const uint64_t all = f.geometry + f.structures, limit = options.tiles.bytes;
  if (!limit || f.tiles == 0) return;
  const double share = static_cast<double>(limit) / static_cast<double>(std::max<uint64_t>(all, 1));
  std::printf("in %s about %.0f of them fit; the largest takes %s%s\n", text(limit).c_str(),
              std::min(1.0, share) * static_cast<double>(f.tiles), text(f.largest).c_str(),
              f.largest > limit ? ", which is more, and is held all the same" : "");
}

}  // namespace

void dry_run(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& options,
             const RenderOptions& o) {
  const bool pictures = o.ranks.empty() && !(options.share && options.share->runs());
  if (o.study.empty()) check_place(o, sim, pictures);
  check_captures(scene, sim, options);
  check_wishes(sim, Facts(sim, scene));
  print_forecast(scene, sim, options);
  std::fputs(heat_forecast(scene, sim, options, o).c_str(), stdout);
  for (const auto& sensor : sim.sensors) {
    std::printf("sensor '%s'\n", sensor->name().c_str());
    for (const SpectralState& s : sensor->states())
      std::printf("  state %s\n", s.choice.error > 0 ? strf("%.4g-%.4g um, bins for a spectral error of %g %%, "
                                                            "reference %.4g um",
                                                            s.low_um, s.high_um, 100 * s.choice.error, s.reference_um)
                                                           .c_str()
                                                     : s.text().c_str());
    for (const Task& t : sensor->tasks())
      for (const Capture& c : t.captures)
        std::printf("  task '%s', capture '%s': %u x %u problems, %g to %g s\n", t.name.c_str(), c.name.c_str(),
                    c.columns, c.rows, c.window.begin, c.window.end);
  }
  const JobOrder order = order_of(sim.sensors, false, sim.sources.dated());
  std::printf("order of the captures:");
  for (const size_t id : order.captures) std::printf(" %zu", id);
  std::printf("; %zu changes of state\nat least %s paths; accumulators and results of the largest capture take %s\n",
              order.state_changes, human_count(forecast_paths(sim.sensors, options)).c_str(),
              human_bytes(forecast_bytes(sim.sensors, options)).c_str());
  if (!options.share) return;
  size_t blocks = 0, mine = 0;
  for (const std::vector<uint8_t>& capture : blocks_of_share(sim.sensors, *options.share))
    for (const uint8_t m : capture) ++blocks, mine += m;
  std::printf("%s runs %zu of %zu blocks of pixels, these paths\n", options.share->text().c_str(), mine, blocks);
}

}  // namespace suite
