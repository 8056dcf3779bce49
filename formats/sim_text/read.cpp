#include <algorithm>
#include <set>

#include "formats/curve/curve.h"
#include "formats/preset/preset.h"
#include "formats/sim_text/air_tables.h"
#include "formats/sim_text/context.h"
#include "formats/sim_text/heat.h"
#include "formats/sim_text/scenes.h"
#include "formats/sim_text/sim_text.h"
#include "formats/sim_text/sources.h"
#include "lidar/lidar_text.h"
#include "transport/technique_switches.h"
#include "transport/truth/truth.h"

namespace suite {

namespace {

void read_preview(const Params& p, PreviewSpec& out) {
  const bool map = p.kind() == Params::Kind::map;
  if (const auto bands = map ? p.find("bands") : p) {
    for (const Params& band : bands->items()) out.bands.push_back(band.as_text());
    if (out.bands.size() != 1 && out.bands.size() != 3)
      throw bands->error(strf("a preview has one band or three, found %zu", out.bands.size()));
  }
  if (!map) return;
  if (const auto show = p.find("show"))
    out.show = show->as_choice({"radiance", "kelvin"}) ? PreviewSpec::Show::kelvin : PreviewSpec::Show::radiance;
  if (out.show == PreviewSpec::Show::kelvin && out.bands.size() == 3)
    throw p.at("show").error("kelvin are shown of one band, three are named", "bands: [NAME]");
  const auto two = [&](const char* key, double low, double high) -> std::optional<std::array<double, 2>> {
    const auto pair = p.find(key);
    if (!pair) return std::nullopt;
    const std::vector<double> v = pair->as_numbers();
    if (v.size() != 2 || !(v[0] >= low && v[0] < v[1] && v[1] <= high))
      throw pair->error(strf("'%s' is not a lower and a higher value", key),
                        strf("two numbers from %g to %g", low, high));
    return std::array<double, 2>{v[0], v[1]};
  };
  if (const auto stretch = two("stretch", 0, 100)) out.low_percent = (*stretch)[0], out.high_percent = (*stretch)[1];
  out.range = two("range", 0, kLargestNumber);
  if (out.range && p.has("stretch")) throw p.at("stretch").error("'range' and 'stretch' exclude each other");
  out.gamma = p.number_in("gamma", 0.1, 10, "", 0);
  out.bar = p.boolean("bar", true);
}

void read_output(const Params& p, OutputSpec& out) {
  if (const auto type = p.find("type"))
    out.type = static_cast<OutputSpec::Type>(type->as_choice({"float32", "float64", "uint16"}));
  if (out.type == OutputSpec::Type::uint16) out.scale = p.number_in("scale", 1e-30, 1e30, "(units of one count)");
  if (const auto files = p.find("files"))
    out.files = static_cast<OutputSpec::Files>(1 + files->as_choice({"capture", "task", "simulation"}));
  if (const auto units = p.find("units"))
    out.units =
        static_cast<OutputSpec::Units>(units->as_choice({"W/(m2 sr um)", "W/(cm2 sr um)", "photons/(s m2 sr um)"}));
  if (const auto also = p.find("also"))
    for (const Params& format : also->items())
      (format.as_choice({"geotiff", "exr"}) == 0 ? out.geotiff : out.exr) = true;
  if (const auto order = p.find("interleave"))
    out.order = static_cast<OutputSpec::Order>(order->as_choice({"bsq", "bil", "bip"}));
  if (const auto preview = p.find("preview")) read_preview(*preview, out.preview);
  if (const auto previews = p.find("previews"))
    for (const std::string& sensor : previews->keys()) read_preview(previews->at(sensor), out.previews[sensor]);
}

// Truth that nobody collects, or that needs a scene on the Earth which is not on it.
void check_truth(const Params& sensor, const SensorContext& context) {
  const auto list = sensor.find("truth");
  if (!list) return;
  for (const Params& item : list->items()) {
    const std::string name = item.as_text();
    truth_rows().find(name, item.where());
    if ((name == "ecef" || name == "geodetic") && !context.frame())
      throw item.error("the truth '" + name + "' needs a scene with an origin on the Earth",
                       "give the scene an origin");
  }
}

}  // namespace

namespace {

// Of a simulation with an epoch: the times of its tasks lie within the range of dates.
void check_times(const Params& p, const Sensor& sensor, const SensorContext& context) {
  for (const Task& task : sensor.tasks())
    for (const double t : {task.window.begin, task.window.end}) try {
        context.utc(t);
      } catch (const Error& e) {
        const Params place = p.has("time_s") ? p.at("time_s") : p;
        throw place.error(strf("%.9g s after the epoch: %s", t, e.message().c_str()), e.hint());
      }
}

void read_techniques(const Params& p, PipelineOptions& options) {
  for (const std::string& key : p.keys()) {
    const NamedTechnique* technique = technique_of(key);
    if (!technique) throw Error(p.where(key), "there is no technique '" + key + "'", "one of: " + names_of_switches());
    if (!technique->off)
      throw Error(p.where(key), "'" + key + "' has no switch here, for its light would be missing",
                  "`atmosphere: {" + key + ": false}` leaves it out; here: " + names_of_switches());
    if (!p.at(key).as_bool()) technique->off(options);
  }
}

// What a sensor finds wrong without knowing where stands at the sensor.
std::unique_ptr<Sensor> make_sensor_at(const Params& p, const SensorContext& context) {
  try {
    return make_sensor(p, context);
  } catch (const Error& e) {
    if (!e.where().file.empty()) throw;
    throw p.error(e.message(), e.hint(), e.code());
  }
}

// Names of all.
std::set<std::string> read_sensors(const Params& list, Simulation& sim, const SensorContext& context,
                                   std::span<const AskedCurve> asked) {
  std::set<std::string> names;
  for (const Params& p : list.items()) {
    std::string name;
    if (is_lidar(p)) {
      sim.lidars.push_back({read_lidar(p, context), p.where()});
      LidarInstrument& lidar = sim.lidars.back().instrument;
      lidar.epoch = sim.epoch;
      for (const AskedCurve& curve : asked) check_coverage(curve, lidar);
      name = lidar.name;
    } else {
      check_truth(p, context);
      sim.sensors.push_back(make_sensor_at(p, context));
      sim.sensor_where.push_back(p.where());
      const Sensor& sensor = *sim.sensors.back();
      check_times(p, sensor, context);
      for (const AskedCurve& curve : asked) check_coverage(curve, sensor, p.where());
      if (sim.sources.tabled) check_coverage(*sim.sources.tabled, sensor, p.where());
      name = sensor.name();
    }
    if (!names.insert(name).second)
      throw p.error("two sensors are named '" + name + "'", "give each its own `name`: it names the output files");
  }
  if (names.empty()) throw list.error("a simulation needs at least one sensor");
  return names;
}

}  // namespace

Simulation read_simulation(const std::string& path, const SimulationCallbacks& callbacks,
                           std::vector<std::string> settings) {
  const Params root = parse_simulation(path, settings);
  return read_simulation_tree(root, path, callbacks, std::move(settings));
}

Simulation read_simulation_tree(const Params& root, const std::string& path, const SimulationCallbacks& callbacks,
                                std::vector<std::string> settings) {
  if (!root.has("sensors") && (root.has("materials") || root.has("world")))
    throw root.error("this is the text of a scene, not of a simulation",
                     "prepare it with scene-prep, and name the prepared scene by 'scene:' in a simulation text");
  Simulation sim;
  sim.path = path;
  sim.settings = std::move(settings);
  read_scenes(root, sim);
  sim.pipeline.seed = static_cast<uint64_t>(root.integer("seed", 0, 1LL << 53, 1));
  sim.pipeline.max_nodes = static_cast<int>(root.integer("max_nodes", 0, 1'000'000, 0));
  sim.pipeline.max_scatterings = static_cast<uint32_t>(root.integer("max_scatterings", 0, 10'000'000, 0));
  sim.pipeline.refracted_sources = root.boolean("manifold_nee", true);
  if (!root.boolean("caustic_guiding", true)) sim.pipeline.gloss_photons = 0;
  if (const auto p = root.find("techniques")) read_techniques(*p, sim.pipeline);
  std::vector<AskedCurve> asked;
  sim.sources = read_sources(root, asked);
  if (const auto p = root.find("periodic")) {
    const std::vector<double> low = p->at("origin_m").as_numbers(), size = p->at("size_m").as_numbers();
    if (low.size() != 2 || size.size() != 2) throw p->error("origin_m and size_m are two numbers each: east, north");
    for (const double s : size)
      if (!(s >= 1e-6 && s <= 1e9)) throw p->at("size_m").error("the cell needs a positive size", "1e-6 to 1e9 m");
    if (sim.sources.earth) throw p->error("a scene that repeats itself has no earth under it", "drop one of them");
    sim.periodic = Periodic{{low[0], low[1]}, {size[0], size[1]}};
    sim.periodic_where = p->where();
  }
  if (const auto output = root.find("output")) read_output(*output, sim.output);
  read_epoch(root, sim);
  SensorContext context = sensor_context(sim, callbacks);
  context.curve = read_curve_value;
  context.responses = [](const Params& file) {
    std::vector<NamedResponse> bands;
    for (NamedCurve& c : read_responses(file.as_path())) bands.push_back({std::move(c.name), std::move(c.curve)});
    return bands;
  };
  sim.heat = read_heat_request(root, sim, context);
  const std::set<std::string> names = read_sensors(root.at("sensors"), sim, context, asked);
  for (const auto& [sensor, preview] : sim.output.previews)
    if (!names.contains(sensor))
      throw Error(root.at("output").at("previews").where(sensor), "there is no sensor '" + sensor + "'",
                  name_hint(sensor, std::vector<std::string>(names.begin(), names.end())));
  if (sim.lidars.empty())
    root.reject_unread();
  else
    sim.unread = root;
  sim.files.assign(root.paths().begin(), root.paths().end());
  return sim;
}

}  // namespace suite
