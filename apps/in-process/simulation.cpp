// Simulations at the border: rays that are rendered as the pixels of dirsig-render are.
#include <algorithm>
#include <cmath>
#include <vector>

#include "apps/in-process/border.h"
#include "apps/in-process/rays.h"
#include "apps/in-process/reading.h"
#include "apps/in-process/remote_scenes.h"
#include "base/diagnostics.h"
#include "base/error.h"
#include "base/renamed.h"
#include "heat/seen_warmth.h"
#include "scheduler/bins.h"
#include "scheduler/moments.h"
#include "scheduler/through_tables.h"

namespace suite {

namespace {

using Messages = std::vector<std::string>;

Sensor& sensor_of(const Simulation& sim, const char* name) {
  std::string all;
  for (const auto& sensor : sim.sensors) {
    if (name ? sensor->name() == name : sim.sensors.size() == 1) return *sensor;
    all += (all.empty() ? "" : ", ") + sensor->name();
  }
  const Where where{sim.path, 0, 0, {}, -1};
  if (all.empty())
    throw Error(where, "the simulation has no sensor of radiance", "rs_lidar_open opens its laser radars");
  if (!name) throw Error(where, strf("the simulation has %zu sensors", sim.sensors.size()), "name one of " + all);
  throw Error(where, "there is no sensor '" + printable(name) + "'", "known: " + all);
}

Heating heating_of(const Simulation& sim, const Scene& scene, const SpectralState& state) {
  if (!waits_for_heat(scene)) return {};
  if (!sees_warmth(state)) return {.pending = true};
  throw Error(Where{sim.path, 0, 0, {}, -1}, "a band sees temperatures that follow from weather",
              "dirsig-render finds them; bands below 2 um do not see them");
}

}  // namespace

}  // namespace suite

struct rs_simulation {
  rs_simulation(const char* path, const char* name, suite::Messages& messages)
      : sim(suite::simulation_of(path)), sensor(suite::sensor_of(sim, name)), scene(suite::scenes_of(sim)) {
    using namespace suite;
    for (const RenamedUse& use : take_renamed_uses()) messages.push_back(line_of({Dr::renamed, text_of(use)}));
    const Where where{sim.path, 0, 0, {}, -1};
    if (sensor.states().size() != 1 || sensor.tasks().empty())
      throw Error(where, strf("sensor '%s' has %zu spectral states", sensor.name().c_str(), sensor.states().size()),
                  "name a sensor of one");
    const std::vector<BinReport> reports = choose_bins(*scene, sources_at_all_times(sim.sources, *scene), sensor);
    add_biases(reports, biases);
    for (const BinReport& r : reports)
      if (!r.met())
        messages.push_back("bands are less exact than asked for: " + (r.missed.empty() ? r.text() : r.missed_text()));
    heating = heating_of(sim, *scene, sensor.states()[0]);
  }
  const suite::Capture& first() const { return sensor.tasks()[0].captures.at(0); }

  suite::Simulation sim;
  suite::Sensor& sensor;
  std::shared_ptr<suite::Scene> scene;
  suite::Heating heating;
  suite::BandBiases biases;
};

namespace suite {

namespace {

Handles<rs_simulation>& simulations() {
  static auto* const all = new Handles<rs_simulation>;  // never destroyed: threads may use it to the end of the process
  return *all;
}

void render(const rs_simulation& s, const RayRequests& rays, uint32_t paths, uint64_t seed, const RayAnswers& answers,
            Messages& messages) {
  const auto bands = s.sensor.bands(0);
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<RaySensor>(
      s.sensor.name(), s.sensor.states()[0], std::vector<Band>(bands.begin(), bands.end()), s.first(), rays, answers));
  for (const Capture& c : sensors[0]->tasks()[0].captures)
    check_motion(*s.scene, c.window.begin, c.window.end, Where{s.sim.path, 0, 0, {}, -1});
  SourceSpecs sources = s.sim.sources;
  look_through_tables(sources, *s.scene, sensors);
  describe_sources(sources, *s.scene, sensors);  // refuses skies without a sun
  JobOptions options;
  options.pipeline = s.sim.pipeline;
  options.pipeline.seed = seed;
  options.periodic = s.sim.periodic;
  options.heating = s.heating;
  options.biases = s.biases;
  options.progress = false;
  if (paths) options.budget.min_paths = options.budget.max_paths = paths, options.budget.relative_error = 0;
  const auto keep = [&](const Diagnostic& d) { messages.push_back(line_of(d)); };
  options.diagnose = keep;
  const JobReport report = run_job(s.scene, sources, sensors, options);
  for (const JobReport::SensorShortfall& lacks : report.shortfalls)
    for (const Diagnostic& d : diagnose_shortfall(lacks.sensor, lacks.shortfall)) keep(d);
}

}  // namespace

}  // namespace suite

using suite::at_border;
using suite::need;

int rs_simulation_open(const char* path, const char* sensor, rs_simulation** simulation) {
  return at_border([&](suite::Messages& messages) {
    need(simulation, "simulation");
    *simulation = suite::simulations().add(std::make_shared<const rs_simulation>(path, sensor, messages));
  });
}

void rs_simulation_close(rs_simulation* simulation) { suite::simulations().close(simulation); }

void rs_simulation_describe(const rs_simulation* handle, rs_simulation_info* info) {
  *info = {};
  const auto simulation = suite::simulations().find(handle);
  if (!simulation) return;
  const suite::Capture& c = simulation->first();
  *info = {simulation->sensor.bands(0).size(), c.convergence.max_paths, simulation->sim.pipeline.seed, c.window.begin,
           c.window.end};
}

const char* rs_simulation_band(const rs_simulation* handle, size_t number, double* center_um) {
  const auto simulation = suite::simulations().find(handle);
  if (!simulation) return nullptr;
  const auto bands = simulation->sensor.bands(0);
  if (number >= bands.size()) return nullptr;
  if (center_um) *center_um = bands[number].center_um;
  return bands[number].name.c_str();
}

int rs_simulation_radiance(const rs_simulation* handle, size_t n, const double* origin, const double* direction,
                           const double* time, uint32_t paths, uint64_t seed, double* radiance, double* standard_error,
                           uint8_t* quality) {
  return at_border([&](suite::Messages& messages) {
    const auto simulation = suite::simulations().get(handle, "simulation");
    if (seed > (uint64_t{1} << 53)) throw suite::Error("a seed above 2^53");
    if (paths > (1u << 30)) throw suite::Error(suite::strf("%u paths", paths), "up to 2^30");
    if (n == 0) return;
    need(origin, "origin");
    need(direction, "direction");
    need(radiance, "radiance");
    need(standard_error, "standard_error");
    if (n > UINT32_MAX) throw suite::Error(suite::strf("%zu rays in one call", n), "up to 2^32 - 1");
    suite::need_finite(origin, n, 3, "origin");
    suite::need_units(direction, n, "direction");
    if (time) suite::need_finite(time, n, 1, "time");
    suite::RayRequests rays{n, origin, direction, std::vector<double>(n, simulation->first().window.begin)};
    if (time) rays.time.assign(time, time + n);
    suite::render(*simulation, rays, paths, seed, {radiance, standard_error, quality}, messages);
  });
}
