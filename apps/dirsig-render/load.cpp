#include "load.h"

#include <filesystem>

#include "base/progress.h"
#include "base/stopwatch.h"
#include "formats/sqt/sqt.h"
#include "heat.h"
#include "lidar.h"
#include "scene/combine.h"
#include "scheduler/prepass.h"
#include "together.h"

namespace suite {

namespace {

// What the sensors can see decides what is loaded.
SceneNeeds needs_of(const Simulation& sim, const JobOptions& options, const RenderOptions& render, Ranks* ranks) {
  SceneNeeds needs;
  needs.windows_um = windows_um(sim.sensors, options.prepasses);
  for (const std::array<double, 2>& window : lidar_windows_um(sim)) needs.windows_um.push_back(window);
  for (const auto& sensor : sim.sensors)
    for (const std::string& truth : sensor->truth())
      needs.temperatures = needs.temperatures || truth.starts_with("temperature");
  if (sim.heat && sees_heat(sim, render))
    for (const std::array<double, 2>& window : heat_windows_um()) needs.windows_um.push_back(window);
  // Under a limit all of it can be let go.
  needs.later_from = options.tiles.bytes ? 0 : uint64_t{64} << 20;
  if (ranks) needs.spill = spill_file(*ranks);
  return needs;
}

// Whether any capture looks at a time in a span. (With an epoch of the text, whose seconds may count from elsewhere, it
// may.)
bool seen(const Simulation& sim, const JobOptions& options, TimeSpan life) {
  if (sim.epoch || !sim.lidars.empty()) return true;
  for (const Sensors all : {Sensors(sim.sensors), options.prepasses})
    for (const auto& sensor : all)
      for (const Task& task : sensor->tasks())
        for (const Capture& c : task.captures)
          if (c.window.end >= life.begin && c.window.begin < life.end) return true;
  return false;
}

}  // namespace

LoadedScene load_scenes(const Simulation& sim, const JobOptions& options, const RenderOptions& render, Ranks* ranks) {
  const bool all = render.load_all;
  LoadedScene out;
  const Stopwatch::time_point first = Stopwatch::now();
  std::vector<ScenePart> parts;
  const SceneNeeds needs = all ? SceneNeeds{} : needs_of(sim, options, render, ranks);
  for (const SimulationScene& s : sim.scenes) {
    if (!parts.empty() && !all && !seen(sim, options, s.life)) {  // the first gives the others their frame
      note("of " + s.path + ": nothing is loaded, it is not there in any capture");
      continue;
    }
    LoadReport loaded;
    const Stopwatch::time_point begun = Stopwatch::now();
    Scene scene = read_scene(
        s.path, [](std::span<const std::byte> bytes, const std::string& name) { return parse_sqt(bytes, name).bundle; },
        needs, &loaded);
    note("of " + s.path + strf(", loaded in %.3f s:\n", seconds_since(begun)) + loaded.text() +
         "(--explain FEATURE says why)");
    if (loaded.later) out.later.push_back(loaded.later);
    parts.push_back({std::filesystem::path(s.path).stem().string(), std::move(scene), s.placement, s.motion, s.life});
  }
  const bool whole = parts.size() == 1 && !parts[0].placement && !parts[0].motion && parts[0].life == kAlways;
  try {
    out.scene = std::make_shared<Scene>(whole ? std::move(parts[0].scene) : combine_scenes(std::move(parts)));
  } catch (const Error& e) {
    throw Error(Where{sim.path, 0, 0, {}, -1}, e.message(), e.hint());
  }
  out.seconds = seconds_since(first);
  return out;
}

}  // namespace suite
