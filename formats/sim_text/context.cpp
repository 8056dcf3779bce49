#include "formats/sim_text/context.h"

#include <cmath>

#include "formats/motion/motion.h"
#include "formats/raster/raster.h"
#include "formats/tle/tle.h"

namespace suite {

namespace {

GreyImage read_grey(const std::string& path) {
  const Raster raster = read_raster(path, size_t{1} << 24);
  GreyImage image{raster.width, raster.height, {}};
  for (size_t i = 0; i < raster.values.size(); i += raster.channels) image.values.push_back(raster.values[i]);
  return image;
}

}  // namespace

void read_epoch(const Params& root, Simulation& sim) {
  if (const auto epoch = root.find("epoch")) {
    try {
      sim.epoch = parse_iso8601(epoch->as_text());
    } catch (const Error& e) {
      throw epoch->error(e.message(), e.hint());
    }
  }
  // Sun and Moon by date stand there at second 0, and go on with the simulation's one clock.
  SourceSpecs& s = sim.sources;
  for (const LightSpecPtr& light : s.lights) {
    const SourceTime* const time = light->date();
    if (!time) continue;
    const Utc date = parse_iso8601(time->utc);
    if (!sim.epoch) sim.epoch = date;
    if (std::fabs(instant_from_utc(date) - instant_from_utc(*sim.epoch)) > 1e-6)
      throw Error(
          time->where,
          strf("the %s's date is not that of second 0, which is %s", light->key().c_str(),
               to_iso8601(*sim.epoch).c_str()),
          "give the same date: Sun and Moon set by date move with the captures' times; one that stands still has a "
          "direction {zenith_deg, azimuth_deg}");
  }
  sim.dut1_given = root.has("dut1_s");
  sim.dut1 = s.dut1 = root.number_in("dut1_s", -0.9, 0.9, "s", 0);
}

SensorContext sensor_context(const Simulation& sim, const SimulationCallbacks& callbacks) {
  // The scene is asked for its origin once, and only by a sensor that moves.
  struct Shared {
    MotionContext motion;
    bool asked = false;
  };
  auto shared = std::make_shared<Shared>();
  shared->motion.dut1 = sim.dut1;
  shared->motion.dut1_given = sim.dut1_given;
  if (sim.epoch) shared->motion.clock = Clock(*sim.epoch);
  shared->motion.satellites = [](const std::string& path, const std::string& name) {
    return read_tle_of(path, name).elements;
  };
  shared->motion.satellite_lines = [](const std::string& lines, const std::string& file) {
    return parse_tle(lines, file).at(0).elements;
  };
  auto motion = [shared, origin = callbacks.origin, path = sim.path, scenes = sim.scenes]() -> const MotionContext& {
    if (!shared->asked && origin) {
      const GeodeticOrigin at = origin(path, scenes);
      if (at.given) shared->motion.frame = SceneFrame({at.latitude_deg, at.longitude_deg, at.ellipsoid_height_m});
    }
    shared->asked = true;
    return shared->motion;
  };
  SensorContext context;
  context.deliver = callbacks.deliver;
  context.track = [motion](const Params& p) { return track_from(p, motion()); };
  context.position = [motion](const Params& p) { return position_from(p, motion()); };
  context.jitter = [](const Params& p, uint64_t seed) { return jitter_from(p, seed); };
  context.image = read_grey;
  context.frame = [motion] { return motion().frame; };
  context.time = [shared](const Params& p) { return time_value(p, shared->motion); };
  context.utc = [shared](double t) {
    return shared->motion.clock ? to_iso8601(shared->motion.clock->utc(t), 6) : std::string();
  };
  return context;
}

}  // namespace suite
