#include "run.h"

#include <cmath>

#include "air_lut.h"
#include "air_report.h"
#include "base/diagnostics.h"
#include "base/files.h"
#include "base/inputs.h"
#include "base/interrupt.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "base/renamed.h"
#include "bin_choice.h"
#include "budget_options.h"
#include "continued.h"
#include "deck_report.h"
#include "detect.h"
#include "detection/detectors.h"
#include "dirsig_import.h"
#include "dry_checks.h"
#include "dry_run.h"
#include "flags_report.h"
#include "formats/preset/preset.h"
#include "formats/scene_hdf/scene_hdf.h"
#include "formats/sim_text/sim_text.h"
#include "formats/sqt/sqt.h"
#include "guard.h"
#include "heat.h"
#include "helios_survey.h"
#include "lidar.h"
#include "light/light_rows.h"
#include "load.h"
#include "log.h"
#include "optics/models.h"
#include "output.h"
#include "parts.h"
#include "preview.h"
#include "rehearse.h"
#include "scene/combine.h"
#include "scheduler/air_limits.h"
#include "scheduler/bins.h"
#include "scheduler/features.h"
#include "scheduler/moments.h"
#include "scheduler/prepass.h"
#include "scheduler/through_tables.h"
#include "sensor/deflectors/deflector.h"
#include "sensor/detectors/detectors.h"
#include "sensor/plugin.h"
#include "start.h"
#include "stokes_checks.h"
#include "study.h"
#include "together.h"
#include "transport/channels.h"
#include "transport/truth/truth.h"
#include "view.h"

namespace suite {

namespace {

// A table of kinds.
int print(const std::string& list) {
  std::fputs(list.c_str(), stdout);
  return 0;
}

// Old names of keys and options that were met since the last call.
void report_renamed() {
  for (const RenamedUse& use : take_renamed_uses()) emit({Dr::renamed, text_of(use)});
}

// The row of a diagnostic, by its code.
std::string explain_code(const std::string& text) {
  const Dr code = diagnostic_code(text);
  const DiagnosticKind& kind = diagnostic_kind(code);
  return strf("%s: %s: %s\n  %s\n", code_text(code).c_str(), to_text(kind.severity), kind.condition, kind.cure);
}

// Features of the renderer, those of what is loaded, and diagnostics.
std::string explain(const std::string& feature) {
  if (feature.starts_with("DR")) return explain_code(feature);
  if (const auto text = explain_use(feature)) return *text;
  try {
    return explain_feature(feature);
  } catch (const Error& e) {
    const std::vector<std::string> names = explained_names();
    const std::string near = nearest_name(feature, names);
    std::string all;
    for (const std::string& name : names) all += ", " + name;
    throw Error(e.message(), near.empty() ? e.hint() + all : "did you mean '" + near + "'?");
  }
}

void report_job(const JobReport& r, const Scene& scene) {
  const double paths = static_cast<double>(r.statistics.paths);
  note(strf("%s paths, %s rays, %.2f nodes a path, %.1f %% of the CPU time inside the ray tracer",
            human_count(paths).c_str(), human_count(static_cast<double>(r.statistics.trace.rays)).c_str(),
            paths > 0 ? static_cast<double>(r.statistics.nodes) / paths : 0, 100 * r.share_in_embree));
  note(strf("median relative standard error %.2f %%", 100 * r.median_relative_error));
  report_quality(r.quality);
  note(r.stopped_by);
  if (const TileUse& t = r.tiles; t.built)
    note(
        strf("tiles: %llu buildings, %llu at once at the most; the most at once: %s of ray tracer's structures, %s of "
             "geometry under them",
             static_cast<unsigned long long>(t.built), static_cast<unsigned long long>(t.most_tiles),
             human_bytes(static_cast<double>(t.most_structures)).c_str(),
             human_bytes(static_cast<double>(t.most_geometry)).c_str()));
  if (paths > 0 && r.statistics.truncated > 0)
    note(strf("cut at the maximum number of nodes: %.3g %% of the throughput at the reference wavelength",
              100 * r.statistics.truncated / paths));
  if (const auto leaks = diagnose_leaks(r.statistics, scene)) emit(*leaks);
  for (const JobReport::SensorShortfall& s : r.shortfalls)
    for (const Diagnostic& d : diagnose_shortfall(s.sensor, s.shortfall)) emit(d);
}

void report_job(const JobReport& r, const Scene& scene, const JobOptions& options, const std::string& folder) {
  report_points(options.heating);
  if (options.share && (options.share->runs() || r.captures_waiting)) return report_share(r, *options.share, folder);
  report_job(r, scene);
}

// Runs the job so that a signal ends it in good order and a result that cannot be written tells what there is.
JobReport run_safely(const std::shared_ptr<const Scene>& scene, const Simulation& sim, JobOptions& options,
                     const std::string& folder, const size_t& delivered) {
  const StopInGoodOrder signals;
  options.stop = [] { return stop_signal() != 0; };
  options.begun = [&](const StoredWork& w) {
    if (w.paths > 0)
      note(strf("the state holds %zu of %zu captures whole and %s paths, which are not run again", w.finished,
                w.captures, human_count(w.paths).c_str()));
  };
  try {
    return run_job(scene, sim.sources, sim.sensors, options);
  } catch (const Error& e) {
    if (!e.where().file.starts_with(in_folder(folder, ""))) throw located_in_captures(e, scene, sim, options);
    size_t captures = 0;
    for (const auto& sensor : sim.sensors)
      for (const Task& task : sensor->tasks()) captures += task.captures.size();
    throw Error(e.where(), e.message(),
                (e.hint().empty() ? "" : e.hint() + "; ") + what_is_left(folder, delivered, captures, options));
  }
}

void write_sensor_logs(const Simulation& sim, OutputWriter& writer) {
  for (const auto& sensor : sim.sensors)
    for (const TextFile& log : sensor->logs()) writer.write_text(log);
}

// What is told and written of a whole run.
void conclude(const JobReport& report, const JobOptions& options, const std::string& folder, const Simulation& sim,
              const LoadedScene& loaded, const LidarJobs& lidars, OutputWriter& writer) {
  report_job(report, *loaded.scene, options, folder);
  for (const auto& reads : loaded.later) note(reads->text());
  write_log(in_folder(folder, "render.json"), report, options, lidars.log());
  if (!report.captures_waiting) write_sensor_logs(sim, writer);
}

// What was asked instead of a picture; nothing when one is wanted.
std::optional<int> answer(const Cli& cli, const RenderOptions& o) {
  if (!o.detect.empty()) return run_detect(cli, o);
  if (o.list_sensors) return print(sensor_kinds().list());
  if (o.list_sources) return print(light_rows().list());
  if (o.list_detectors) return print(lidar_detectors().list());
  if (o.list_image_detectors) return print(array_detectors().list());
  if (o.list_deflectors) return print(deflectors().list());
  if (o.list_presets) return print(list_presets());
  if (!o.preset.empty()) return print(preset_text(o.preset));
  if (o.lidar_presets) return print(list_lidar_presets());
  if (!o.lidar_preset.empty()) return print(preset_text(o.lidar_preset));
  if (o.list_truth) return print(truth_rows().list());
  if (o.list_channels) return print(channel_rows().list());
  if (o.list_models) return print(models().list());
  if (o.list_diagnostics) return print(diagnostics_text());
  if (!o.explain.empty()) {
    const int code = print(explain(new_part_name(o.explain)));
    report_renamed();
    return code;
  }
  const bool deck = o.air && is_deck(o.simulation);
  if (!o.against.empty() && !deck) throw UsageError("--against belongs to --air and a deck (.tp5, .ltn, tape5)");
  if (deck) return print(deck_text(o.simulation, o.against));
  return std::nullopt;
}

void check_usage(const Cli& cli, const RenderOptions& o, const Ranks* ranks) {
  if (ranks) check_ranks_usage(cli, o);
  check_import_usage(o);
  if (cli.given("--more") && (o.more < 0 || o.more > (1LL << 30)))
    throw UsageError("--more wants a number from 0 to 2^30");
  if (cli.given("--seed") && (o.seed < 0 || o.seed > (1LL << 53)))
    throw UsageError("--seed wants a whole number from 0 to 2^53");
  if (o.study.empty() && (cli.given("--study-budgets") || cli.given("--study-seeds") || cli.given("--reference")))
    throw UsageError("--study-budgets, --study-seeds and --reference belong to --study");
  check_parts_usage(cli, o);
  if (!o.study.empty() && (cli.given("--paths") || cli.given("--time") || cli.given("--target-error") || o.state ||
                           o.resume || cli.given("--more")))
    throw UsageError("--study sets the budgets itself: leave out --paths, --time, --target-error and states");
}

// Reports what takes part, and refuses what the sensors ask for in vain; their bins are chosen on the way.
void check_sensors(Simulation& sim, const Scene& scene, JobOptions& options) {
  for (size_t s = 0; s < sim.sensors.size(); ++s)
    for (const Task& task : sim.sensors[s]->tasks())
      for (const Capture& c : task.captures) check_motion(scene, c.window.begin, c.window.end, sim.sensor_where[s]);
  note("parts of the renderer:\n" +
       text_of(features_of(scene, sim.sources, sim.sensors, options.pipeline, sim.lidars.size())));
  look_through_tables(sim.sources, scene, sim.sensors);
  for (const std::string& sentence : describe_sources(sim.sources, scene, sim.sensors)) note(sentence);
  for (const Diagnostic& d : diagnose_air(sim.sources, scene, sim.sensors, options)) emit(d);
  const std::vector<SourceSpecs> standing = sources_at_all_times(sim.sources, scene);
  BinChooser chooser(scene, standing);
  for (size_t s = 0; s < sim.sensors.size(); ++s) {
    Sensor& sensor = *sim.sensors[s];
    try {
      check_preview(sensor, sim.output.preview_of(sensor.name()));
      for (const std::string& truth : sensor.truth()) truth_rows().find(truth);
      for (const std::string& channel : sensor.channels()) channel_rows().find(channel);
      check_air_asked(sim, scene, sensor);
      check_stokes(sim, sensor);
      choose_bins_of(sensor, chooser, options.biases);
    } catch (const Error& e) {
      throw located(e, scene, sim, s);
    }
  }
}

// As check_sensors(); all is told with a place.
void check_job(Simulation& sim, const Scene& scene, JobOptions& options) {
  try {
    check_sensors(sim, scene, options);
  } catch (const Error& e) {
    throw located(e, scene, sim);
  }
}

// The state of the run, where it is kept; ranks that are not alike are refused, and all are told the budget.
std::unique_ptr<StateStore> join_or_open(const RenderOptions& o, const Simulation& sim, JobOptions& options,
                                         Ranks* ranks) {
  if (ranks) check_alike(*ranks, identity_of(sim, options));
  std::unique_ptr<StateStore> store;
  if (!ranks || ranks->leads()) store = open_store(o, o.output, sim, options);
  options.store = store.get();
  if (!ranks) return store;
  broadcast_budget(*ranks, options.budget);
  options.executor = &ranks->executor();
  return store;
}

SceneNotes notes_of(const Scene& scene) {
  SceneNotes notes{{}, scene.tags, scene.origin, Tracer::engine()};
  for (const Material& m : scene.materials) notes.materials.push_back(m.id);
  return notes;
}

// What a rank does that does not lead: the same job, of which nothing stays here.
int follow(const std::shared_ptr<const Scene>& scene, const Simulation& sim, JobOptions& options) {
  start_sensors(sim, options, "");
  options.progress = false;
  const StopInGoodOrder signals;
  options.stop = [] { return stop_signal() != 0; };
  try {
    return run_job(scene, sim.sources, sim.sensors, options).stopped ? 128 + stop_signal() : 0;
  } catch (const Error& e) {
    throw located_in_captures(e, scene, sim, options);
  }
}

Simulation simulation_of(const RenderOptions& o, SimulationCallbacks& callbacks, bool alone) {
  // The first scene gives a simulation its frame.
  callbacks.origin = [](const std::string&, const std::vector<SimulationScene>& scenes) {
    return read_scene_origin(scenes.front().path).origin;
  };
  Simulation sim = is_of_dirsig(o.simulation)   ? import_simulation(o, callbacks, alone)
                   : is_of_helios(o.simulation) ? import_survey(o, callbacks)
                                                : read_simulation(o.simulation, callbacks, o.settings);
  report_renamed();
  for (const SimulationScene& s : sim.scenes) note_input(s.path);
  if (o.seed >= 0) sim.pipeline.seed = static_cast<uint64_t>(o.seed);
  if (sim.heat) sim.heat->spec.seed = sim.pipeline.seed;
  if (!o.heat.empty()) sim.files.push_back(o.heat);
  return sim;
}

JobOptions job_options(const Simulation& sim, const RenderOptions& o) {
  JobOptions options;
  options.pipeline = sim.pipeline;
  options.periodic = sim.periodic;
  options.budget = budget_of(o);
  options.share = share_of(o);
  options.kit_bytes = kit_bytes_of(o);
  options.tiles = {tile_bytes_of(o), [](const std::string& text) { emit({Dr::tile_beyond_limit, text}); }};
  options.pipeline.stop = stop_rule_of(o);
  options.pipeline.method = method_of(o);
  return options;
}

// Temperatures that the weather makes, kept of a run that has results, and what finds the light from above.
void find_beforehand(const std::shared_ptr<const Scene>& scene, const Simulation& sim, JobOptions& options,
                     const RenderOptions& o, const Facts& facts, Ranks* ranks) {
  if (!o.heat_only) check_wishes(sim, facts);
  options.heating = heating_of(scene, sim, options, o, o.ranks.empty() && o.study.empty() ? o.output : "", ranks);
  options.prepasses = facts.light_above().passes();
}

// Plug-ins come first: they may bring what is asked for.
void mute_and_load(const RenderOptions& o) {
  for (const std::string& plugin : o.plugins) load_plugin(plugin);
  for (const std::string& code : o.mute) mute(diagnostic_code(code));
  report_renamed();
}

}  // namespace

int run_render(const Cli& cli, const RenderOptions& o, Ranks* ranks) {
  mute_and_load(o);
  if (const auto code = answer(cli, o)) return *code;
  if (show_finished(cli, o)) return 0;
  check_usage(cli, o, ranks);
  if (!o.convert.empty()) return is_of_helios(o.simulation) ? convert_survey(o) : convert_simulation(o);
  std::unique_ptr<OutputWriter> writer;
  SimulationCallbacks callbacks;
  size_t delivered = 0;         // captures whose results were handed over
  StudyImage* study = nullptr;  // where captures go while a study runs
  DetectorFlags flags;
  callbacks.deliver = [&](const Delivery& delivery) {
    if (study) return append(*study, delivery);
    if (!writer) return;  // only the speed is measured
    writer->take(delivery);
    flags.take(delivery);
    ++delivered;
  };
  Simulation sim = simulation_of(o, callbacks, !ranks);
  LidarJobs lidars(cli, o, sim, ranks != nullptr);
  if (!o.air_lut.empty()) return run_air_lut(o, sim);
  JobOptions options = job_options(sim, o);
  const std::vector<int> forecast = ranks_of(cli, o);
  const LinkCosts link = link_of(cli, o);
  if (forecast.empty()) check_memory(sim, options);  // other machines may have more
  // What can be refused is refused before rendering starts.
  const LoadedScene loaded = load_scenes(sim, options, o, ranks);
  const std::shared_ptr<Scene>& scene = loaded.scene;
  if (sim.epoch) set_epoch(*scene, to_iso8601(*sim.epoch, 9));
  lidars.check(scene);
  if (sim.sensors.empty()) return lidars.run_alone(scene, options);
  const AskedStates asked = states_of(sim);
  check_job(sim, *scene, options);
  const bool part = options.share && options.share->runs();
  if (o.dry_run) dry_run(scene, sim, options, o), lidars.forecast();
  if (o.dry_run && forecast.empty()) return 0;
  if (o.air) return print(air_text(sim, scene));
  const Facts facts(sim, scene);
  const RunLock lock = forecast.empty() && (!ranks || ranks->leads()) ? lock_place(o, sim) : RunLock();
  find_beforehand(scene, sim, options, o, facts, ranks);
  if (o.heat_only) return 0;
  follow_heat(sim, *scene, options, asked);
  if (!forecast.empty()) return rehearse(scene, sim, options, forecast, link, loaded.seconds);
  if (!o.study.empty()) return run_study_command(o, scene, sim, options, study);
  if (options.share && options.budget.seconds > 0) refuse_time(scene, sim, options);
  const std::unique_ptr<StateStore> store = join_or_open(o, sim, options, ranks);
  if (ranks && !ranks->leads()) return follow(scene, sim, options);
  check_folder(o.output, sim, !part);
  writer = std::make_unique<OutputWriter>(o.output, sim.output, notes_of(*scene), facts, options.biases);
  if (!sim.sources.any())
    emit({Dr::no_sources, "there is no sun, no sky and no lamp: only materials with a temperature will be seen"});
  options.diagnose = emit;
  if (!lidars.run(scene)) return end_by_signal("no image was begun in " + o.output);
  start_sensors(sim, options, part ? "" : o.output);
  JobReport report = run_safely(scene, sim, options, o.output, delivered);
  flags.add_to(report);
  conclude(report, options, o.output, sim, loaded, lidars, *writer);
  if (!report.stopped) return show_own(o);
  return end_by_signal(what_is_left(o.output, report.captures, report.captures_asked, options));
}

}  // namespace suite
