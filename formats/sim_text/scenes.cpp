#include "formats/sim_text/scenes.h"

#include <filesystem>

#include "formats/motion/motion.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/scene_text/transform.h"
#include "formats/tle/tle.h"

namespace suite {

namespace {

// Motions and times are told in the frame and from second 0 of the first scene.
MotionContext context_of(const std::string& first) {
  MotionContext context;
  const SceneOrigin at = read_scene_origin(first);
  if (at.origin.given)
    context.frame.emplace(Geodetic{at.origin.latitude_deg, at.origin.longitude_deg, at.origin.ellipsoid_height_m});
  if (!at.epoch.empty()) context.clock.emplace(parse_iso8601(at.epoch));
  context.satellites = [](const std::string& path, const std::string& satellite) {
    return read_tle_of(path, satellite).elements;
  };
  context.satellite_lines = [](const std::string& lines, const std::string& file) {
    return parse_tle(lines, file).at(0).elements;
  };
  return context;
}

// The file of a prepared scene; a text is refused where it is named.
std::string prepared(const Params& p) {
  const std::string path = p.as_path(), name = p.as_text();
  const std::string end = std::filesystem::path(path).extension().string();
  if (end == ".yaml" || end == ".yml" || end == ".json")
    throw p.error(
        "'" + name + "' is a text; a prepared scene (.h5) is wanted",
        "prepare it: scene-prep " + name + " -o " + std::filesystem::path(name).replace_extension("h5").string());
  return path;
}

}  // namespace

void read_scenes(const Params& root, Simulation& sim) {
  const auto list = root.find("scenes");
  if (!list) {
    sim.scenes.push_back({prepared(root.at("scene")), {}, {}, kAlways});
  } else {
    if (root.has("scene")) throw list->error("'scene' and 'scenes' exclude each other");
    for (const Params& p : list->items()) {
      if (p.kind() == Params::Kind::scalar) {
        sim.scenes.push_back({prepared(p), {}, {}, kAlways});
        continue;
      }
      SimulationScene scene{prepared(p.at("file")), {}, {}, kAlways};
      scene.placement = find_transform(p);
      const MotionContext context = context_of(sim.scenes.empty() ? scene.path : sim.scenes.front().path);
      if (const auto motion = p.find("motion")) scene.motion = track_from(*motion, context);
      scene.life = read_life(p, context);
      sim.scenes.push_back(std::move(scene));
    }
    if (sim.scenes.empty()) throw list->error("a simulation needs at least one scene");
  }
  sim.scene_path = sim.scenes.front().path;
}

}  // namespace suite
