#include "run.h"

#include <cmath>

#include "base/files.h"
#include "base/progress.h"
#include "budget_options.h"
#include "continued.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/sim_text/sim_text.h"
#include "formats/sqt/sqt.h"
#include "log.h"
#include "motion/ephemeris.h"
#include "optics/models.h"
#include "output.h"

namespace suite {

namespace {

// What the sensors can see decides what is loaded.
SceneNeeds needs_of(const Simulation& sim) {
  SceneNeeds needs;
  for (const auto& sensor : sim.sensors)
    for (const SpectralState& s : sensor->states()) needs.windows_um.push_back({s.low_um, s.high_um});
  return needs;
}

int list_sensors() {
  for (const SensorRow& row : sensor_kinds()) std::printf("%-16s %s\n", row.name.c_str(), row.summary.c_str());
  return 0;
}

int list_models() {
  for (const ModelRow& row : models()) {
    std::printf("%-16s %s\n", row.name.c_str(), row.summary.c_str());
    for (const ModelParameter& p : row.parameters) std::printf("    %-18s %s [%s]%s\n", p.name.c_str(), p.summary.c_str(), p.unit.c_str(), p.required ? "" : ", optional");
  }
  return 0;
}

// The Sun's direction (and size) from date and place.
void resolve_sun(Simulation& sim, const Scene& scene) {
  if (!sim.sun_by_time) return;
  if (!scene.origin.given)
    throw Error(sim.sun_by_time->where, "a sun by date needs a scene with a geodetic origin", "give the scene an origin, or the sun {zenith_deg, azimuth_deg}");
  const SceneFrame frame({scene.origin.latitude_deg, scene.origin.longitude_deg, scene.origin.ellipsoid_height_m});
  const SkyBody sun = sun_at(frame, {}, instant_from_utc(sim.sun_by_time->utc));
  sim.sources.sun->direction = sun.direction;
  if (sim.sun_by_time->disk_from_distance) sim.sources.sun->half_angle = sun.angular_radius;
  note(strf("sun at %s: %.3f degrees above the horizon, %.5f AU", to_iso8601(sim.sun_by_time->utc, 0).c_str(), sun.elevation / kDegree, sun.distance / kAstronomicalUnit));
}

int dry_run(const Simulation& sim, const JobOptions& options) {
  for (const auto& sensor : sim.sensors) {
    std::printf("sensor '%s'\n", sensor->name().c_str());
    for (const SpectralState& s : sensor->states()) std::printf("  state %s\n", s.text().c_str());
    for (const Task& t : sensor->tasks())
      for (const Capture& c : t.captures)
        std::printf("  task '%s', capture '%s': %u x %u problems, %g to %g s\n", t.name.c_str(), c.name.c_str(), c.columns, c.rows, c.window.begin, c.window.end);
  }
  const JobOrder order = order_of(sim.sensors);
  std::printf("order of the captures:");
  for (const size_t id : order.captures) std::printf(" %zu", id);
  std::printf("; %zu changes of state\nat least %s paths; accumulators and results of the largest capture take %s\n", order.state_changes,
              human_count(forecast_paths(sim.sensors, options)).c_str(), human_bytes(forecast_bytes(sim.sensors, options)).c_str());
  return 0;
}

void tell(const JobReport& r) {
  const double paths = static_cast<double>(r.statistics.paths);
  note(strf("%s paths, %s rays, %.2f nodes a path, %.1f %% of the CPU time inside the ray tracer", human_count(paths).c_str(),
            human_count(static_cast<double>(r.statistics.trace.rays)).c_str(), paths > 0 ? static_cast<double>(r.statistics.nodes) / paths : 0, 100 * r.share_in_embree));
  note(strf("median relative standard error %.2f %%; %.2f %% of the pixels are flagged for heavy tails", 100 * r.median_relative_error, 100 * r.share_flagged));
  note(r.stopped_by);
  if (paths > 0 && r.statistics.truncated > 0)
    note(strf("cut at the maximum number of nodes: %.3g %% of the throughput at the reference wavelength", 100 * r.statistics.truncated / paths));
  if (r.statistics.failures) warn(strf("%llu samples were not finite or negative and were left out", static_cast<unsigned long long>(r.statistics.failures)));
}

}  // namespace

int run_render(const Cli& cli, const RenderOptions& o) {
  if (o.list_sensors) return list_sensors();
  if (o.list_models) return list_models();
  if (!o.explain.empty()) return std::fputs(explain_feature(o.explain).c_str(), stdout), 0;
  if (o.simulation.empty()) throw UsageError("a simulation text is required");
  if (cli.given("--more") && (o.more < 0 || o.more > (1LL << 30))) throw UsageError("--more wants a number from 0 to 2^30");

  std::vector<std::string> material_names;
  std::string folder = o.output;
  OutputSpec output;
  const auto deliver = [&](const Sensor& sensor, const CaptureResult& result) {
    for (const std::string& file : write_capture(folder, sensor, result, output, material_names)) note("wrote " + file);
  };
  Simulation sim = read_simulation(o.simulation, deliver);
  output = sim.output;
  if (o.seed >= 0) sim.pipeline.seed = static_cast<uint64_t>(o.seed);
  JobOptions options;
  options.pipeline = sim.pipeline;
  options.periodic = sim.periodic;
  options.budget = budget_of(o);
  options.pipeline.stop = stop_rule_of(o);
  if (o.dry_run) return dry_run(sim, options);

  // Everything that can be refused is refused before rendering starts.
  LoadReport loaded;
  auto scene = std::make_shared<Scene>(read_scene(
      sim.scene_path, [](std::span<const std::byte> bytes, const std::string& name) { return parse_sqt(bytes, name).bundle; }, needs_of(sim), &loaded));
  note("of the scene:\n" + loaded.text() + "(--explain FEATURE says why)");
  resolve_sun(sim, *scene);
  for (const Material& m : scene->materials) material_names.push_back(m.id);
  make_folder(folder);
  if (!sim.sources.sun && !sim.sources.sky) warn("there is no sun and no sky: only materials with a temperature will be seen");
  const std::unique_ptr<StateStore> store = open_store(o, folder, sim, options);
  options.store = store.get();
  const JobReport report = run_job(scene, sim.sources, sim.sensors, options);
  tell(report);
  write_log(folder + "/render.json", report, options);
  return 0;
}

}  // namespace suite
