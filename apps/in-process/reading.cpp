#include "apps/in-process/reading.h"

#include <filesystem>

#include "apps/in-process/border.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/sqt/sqt.h"
#include "scene/combine.h"

namespace suite {

Simulation simulation_of(const char* path) {
  need(path, "path");
  SimulationCallbacks callbacks;
  callbacks.deliver = [](const Delivery&) {};
  callbacks.origin = [](const std::string&, const std::vector<SimulationScene>& scenes) {
    return read_scene_origin(scenes.front().path).origin;
  };
  return read_simulation(path, callbacks);
}

std::shared_ptr<Scene> scenes_of(const Simulation& sim) {
  std::vector<ScenePart> parts;
  for (const SimulationScene& s : sim.scenes)
    parts.push_back(
        {std::filesystem::path(s.path).stem().string(),
         read_scene(s.path, [](auto bytes, const std::string& name) { return parse_sqt(bytes, name).bundle; }),
         s.placement, s.motion, s.life});
  const ScenePart& first = parts[0];
  const bool whole = parts.size() == 1 && !first.placement && !first.motion && first.life == kAlways;
  auto scene = std::make_shared<Scene>(whole ? std::move(parts[0].scene) : combine_scenes(std::move(parts)));
  if (sim.epoch) set_epoch(*scene, to_iso8601(*sim.epoch, 9));
  return scene;
}

}  // namespace suite
