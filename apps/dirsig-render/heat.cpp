#include "heat.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <optional>

#include "base/diagnostics.h"
#include "base/files.h"
#include "base/outputs.h"
#include "base/parallel.h"
#include "base/placed.h"
#include "base/progress.h"
#include "base/run_app.h"
#include "base/stopwatch.h"
#include "formats/heat_hdf/heat_hdf.h"
#include "formats/heat_hdf/operator_hdf.h"
#include "heat/heat_field.h"
#include "heat/seen_warmth.h"
#include "heat/target_paths.h"
#include "heat_left_out.h"
#include "heat_paths.h"
#include "heat_prepared.h"
#include "heat_report.h"
#include "scheduler/prepass.h"

namespace suite {

namespace {

// Truth that is more than temperatures and their errors.
bool asks_fluxes(const Simulation& sim) {
  return std::ranges::any_of(sim.sensors, [](const auto& sensor) {
    return std::ranges::any_of(sensor->truth(), [](const std::string& truth) {
      return truth == "sun_hours" || truth == "absorbed_sun" || truth == "longwave_received";
    });
  });
}

// Sunlight of the elements that are left, with the exchange that is there.
HeatOperator operator_of_left(const PreparedHeat& p, LeftOut& left, const SunCourse& course,
                              const HeatProgress& progress) {
  progress.begin("sunlight", static_cast<double>(p.faces->size()), "face");
  return {left.take_exchange(),
          find_sunlight({*p.tracer, *p.elements, *p.faces, p.optics}, course, path_options(p.spec), nullptr,
                        [&](size_t more) { progress.done(static_cast<double>(more) / kSunStages); })};
}

struct Found {
  HeatResult result;
  WeatherLoads weather;
};

Found find(PreparedHeat& p, const Scene& scene, const Simulation& sim, const RenderOptions& options,
           const std::string& folder) {
  std::unique_ptr<Progress> bar;
  HeatProgress progress;
  progress.begin = [&](const std::string& stage, double whole, const std::string& unit) {
    if (bar) bar->finish();
    bar = std::make_unique<Progress>("heat: " + stage, whole, unit);
  };
  progress.done = [&](double more) { bar->add(more); };
  for (const std::string& sentence : sim.heat->weather->notes()) note("weather: " + sentence);
  Found found{{}, weather_loads(weather_of(sim, scene), p.spec)};
  if (p.spec.target > 0) {
    const TargetPaths t =
        paths_for(p.spec.target, *p.tracer, *p.elements, *p.faces, p.optics, found.weather, p.spec, progress);
    p.spec.paths = t.paths;
    note(strf("heat: %u paths of a face have a standard error of %.2g K: %u for %g K", t.pilot_paths, t.pilot_error,
              t.paths, p.spec.target));
    if (!t.enough)
      emit({Dr::heat_paths, strf("heat: %u paths of a face are the most, and too few for target_error_k %g", kMostPaths,
                                 p.spec.target)});
    check_size(p, sim);
  }
  std::optional<LeftOut> left_out;
  if (sim.heat->leave_out > 0 && !p.elements->rests().empty())
    note("heat: no elements are left out: which matter differs from one interval of rest to another");
  else if (sim.heat->leave_out > 0) {
    const auto [cold, warm] = std::ranges::minmax(found.weather.air_kelvin);
    left_out.emplace(p, sim, std::array{cold, warm}, progress);
  }
  HeatOperator paths = left_out ? operator_of_left(p, *left_out, found.weather.course, progress)
                                : operator_of(p, found.weather.course, sim, options, folder, progress);
  found.result =
      solve_heat({*p.tracer, *p.elements, *p.faces, p.optics}, std::move(paths), found.weather, p.spec, progress);
  if (sim.heat->final_gather) {
    progress.begin("straight sunlight", 0, "");
    found.result.straight =
        straight_sunlight({*p.tracer, *p.elements, *p.faces, p.optics}, found.weather, found.result, p.spec);
  }
  if (bar) bar->finish();
  if (left_out) note("heat: " + left_out->sentence(found.result));
  if (left_out && left_out->bound(found.result) > sim.heat->leave_out)
    emit({Dr::heat_left_out, strf("heat: elements that are left out matter by more than the %g K of influence_cutoff_k",
                                  sim.heat->leave_out)});
  return found;
}

std::vector<std::string> report_sentences(const HeatResult& h, const PreparedHeat& p, double seconds) {
  const std::vector<std::string> sentences = heat_sentences(h, p, seconds);
  for (const std::string& sentence : sentences) note("heat: " + sentence);
  for (const std::string& sentence : h.notes) emit({Dr::heat_limit, "heat: " + sentence});
  return sentences;
}

void keep(const HeatResult& h, const WeatherLoads& weather, const PreparedHeat& p, const Scene& scene,
          const Simulation& sim, const std::vector<std::string>& sentences, const std::string& folder) {
  make_folders_of({in_folder(folder, "heat.h5")});
  std::vector<std::string> names;
  for (const Material& m : scene.materials) names.push_back(m.id);
  write_heat(in_folder(folder, "heat.h5"), h, *p.elements, *p.faces, names, p.cut, command_line());
  write_file(in_folder(folder, "heat.csv"), heat_table(h, p, scene, sim));
  write_file(in_folder(folder, "heat.html"), heat_page(h, p, weather, scene, sim, sentences));
  if (const std::string probes = heat_probes(h, p, weather, scene, sim); !probes.empty())
    write_file(in_folder(folder, "heat_probes.csv"), probes);
  if (h.audit) write_file(in_folder(folder, "heat_audit.csv"), audit_table(*h.audit, p, scene));
}

// Tells what it has, and keeps in the folder what it found.
HeatResult found_or_read(PreparedHeat& p, const Scene& scene, const Simulation& sim, const RenderOptions& options,
                         const std::string& folder) {
  const Stopwatch::time_point begun = Stopwatch::now();
  if (options.heat.empty()) {
    check_size(p, sim);
    Found found = find(p, scene, sim, options, folder);
    const std::vector<std::string> sentences = report_sentences(found.result, p, seconds_since(begun));
    if (!folder.empty()) keep(found.result, found.weather, p, scene, sim, sentences, folder);
    return std::move(found.result);
  }
  HeatResult result = read_heat(options.heat, *p.elements, *p.faces, asks_fluxes(sim));
  if (sim.heat->final_gather && result.straight.empty())
    throw Error(options.heat + ": holds temperatures of elements alone, and `final_gather` asks for points",
                "solve for them again with it, or drop it");
  if (result.span.begin != p.spec.span.begin || result.span.end != p.spec.span.end)
    emit({Dr::heat_other_span,
          strf("%s has temperatures from %g to %g s, the simulation asks for %g to %g s: those of the file are used",
               options.heat.c_str(), result.span.begin, result.span.end, p.spec.span.begin, p.spec.span.end)});
  report_sentences(result, p, seconds_since(begun));
  return result;
}

// Which elements the first rank left out.
void share_kept(PreparedHeat& p, Ranks& ranks) {
  std::vector<std::byte> bytes;
  if (ranks.leads())
    bytes.assign(std::as_bytes(std::span(p.cut.kept)).begin(), std::as_bytes(std::span(p.cut.kept)).end());
  ranks.share(bytes);
  if (ranks.leads()) return;
  std::vector<uint32_t> kept(bytes.size() / sizeof(uint32_t));
  std::memcpy(kept.data(), bytes.data(), bytes.size());
  keep_elements(p, kept);
}

// Points, and what they are found with.
struct FoundPoints {
  WeatherLoads weather;
  PointHeat points;
  FoundPoints(WeatherLoads loads, const PreparedHeat& p, const HeatResult& result)
      : weather(std::move(loads)), points({*p.tracer, *p.elements, *p.faces, p.optics}, weather, result) {}
};

// Null where they are not asked for.
std::shared_ptr<const FoundPoints> points_of(const PreparedHeat& p, const HeatResult& result, const Simulation& sim,
                                             const Scene& scene) {
  if (!sim.heat->final_gather) return nullptr;
  HeatSpec spec = p.spec;
  spec.span = result.span, spec.step = result.step, spec.periodic = result.periodic;
  return std::make_shared<const FoundPoints>(weather_loads(weather_of(sim, scene), spec), p, result);
}

// The field, with what it looks things up in.
struct FoundField final : ExplainedField {
  std::shared_ptr<const PreparedHeat> prepared;
  std::shared_ptr<const FoundPoints> points;
  HeatField field;
  FoundField(std::shared_ptr<const PreparedHeat> all, std::shared_ptr<const HeatResult> found,
             std::shared_ptr<const FoundPoints> found_points)
      : prepared(std::move(all)),
        points(std::move(found_points)),
        field(prepared->elements, std::move(found),
              points ? std::shared_ptr<const PointHeat>(points, &points->points) : nullptr) {}
  double kelvin(const HeatedPlace& place, double time) const override { return field.kelvin(place, time); }
  double error(const HeatedPlace& place, double time) const override { return field.error(place, time); }
  Cause cause(const HeatedPlace& place, double time) const override { return field.cause(place, time); }
  std::array<double, 2> range() const override { return field.range(); }
};

}  // namespace

bool sees_heat(const Simulation& sim, const RenderOptions& options) {
  if (options.heat_only) return true;
  for (const auto& sensor : sim.sensors) {
    for (const SpectralState& s : sensor->states())
      if (sees_warmth(s)) return true;
    for (const std::string& truth : sensor->truth())
      if (truth.starts_with("temperature")) return true;
  }
  return asks_fluxes(sim);
}

std::vector<std::array<double, 2>> heat_windows_um() {
  const SpectralState sun = sunlight_state(), glow = infrared_state();
  return {{sun.low_um, sun.high_um}, {glow.low_um, glow.high_um}};
}

namespace {

// The first sensor that sees it; else the text.
Where where_heat_is_seen(const Simulation& sim) {
  for (size_t s = 0; s < sim.sensors.size(); ++s)
    if (std::ranges::any_of(sim.sensors[s]->states(), [](const SpectralState& state) { return sees_warmth(state); }))
      return sim.sensor_where[s];
  return {sim.path, 0, 0, {}, -1};
}

// Whether temperatures are to be found or read. Error: they cannot be, or are asked for in two ways.
bool asks_heat(const Scene& scene, const Simulation& sim, const RenderOptions& options) {
  if (!waits_for_heat(scene) || !sees_heat(sim, options)) return false;
  if (!sim.heat) {
    for (const TemperatureBinding& t : scene.temperatures)
      if (t.spec.model == "heat")
        throw Error(where_heat_is_seen(sim),
                    "the temperature of material '" + scene.materials[t.material].id +
                        "' follows from weather, which is not given",
                    "add 'weather: FILE' and 'heat: {}'");
  }
  if (!options.heat.empty() && !options.heat_operator.empty())
    throw UsageError("--heat has the temperatures, --heat-operator what they are found with: give one of both");
  if (!options.heat_operator.empty() && sim.heat->leave_out > 0)
    throw Error(sim.heat->where, "--heat-operator has the paths of all elements, and some are to be left out",
                "drop 'influence_cutoff_k' or --heat-operator");
  return true;
}

// Faults of the search are those of `heat`, unless they have a place of their own.
Error at_heat(const Error& fault, const Simulation& sim) {
  return placed(fault, sim.heat ? sim.heat->where : Where{sim.path, 0, 0, {}, -1});
}

Heating heating(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& job,
                const RenderOptions& options, const std::string& folder, Ranks* ranks) {
  if (!waits_for_heat(*scene)) {
    if (sim.heat && sees_heat(sim, options))
      emit({Dr::heat_unused,
            "the simulation has `heat`, and no material of the scene waits for it ('temperature: {model: heat}')"});
    return {};
  }
  if (!sees_heat(sim, options)) {
    note("no band sees the warmth of weather: temperatures are not found");
    report_hot_neighbours(*scene, sim);
    return {.pending = true};
  }
  asks_heat(*scene, sim, options);
  if (!options.part.empty() && options.heat.empty())
    note(
        "heat: every part finds the same temperatures; `--heat-only` finds them once, and `--heat FILE` gives them to "
        "all");
  std::optional<HeatCut> cut;
  if (!options.heat.empty())
    cut = heat_cut(options.heat);
  else if (const std::string from = operator_file(sim, options, folder); !from.empty()) {
    // As many elements as are asked for; else the file is refused when it is read, with what differs.
    cut = operator_cut(from);
    cut->kept.clear();  // what is left out is found again
    if (cut->elements != sim.heat->spec.elements || cut->by_sun != sim.heat->spec.cut_by_sun) cut.reset();
  }
  const bool rays = options.heat.empty() || sim.heat->final_gather;
  auto p = std::make_shared<PreparedHeat>(prepare(scene, sim, job, cut, rays));
  const auto result = std::make_shared<HeatResult>();
  if (!ranks || ranks->leads()) *result = found_or_read(*p, *scene, sim, options, folder);
  if (ranks) {
    std::vector<std::byte> bytes;
    if (ranks->leads()) bytes = packed_field(*result);
    ranks->share(bytes);
    if (!ranks->leads()) *result = unpacked_field(bytes);
    if (sim.heat->leave_out > 0 && options.heat.empty() && p->elements->rests().empty()) share_kept(*p, *ranks);
  }
  return {.field = std::make_shared<const FoundField>(p, result, points_of(*p, *result, sim, *scene))};
}

}  // namespace

Heating heating_of(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& job,
                   const RenderOptions& options, const std::string& folder, Ranks* ranks) {
  try {
    return heating(scene, sim, job, options, folder, ranks);
  } catch (const Error& e) {
    throw at_heat(e, sim);
  }
}

void report_points(const Heating& heating) {
  const auto* found = dynamic_cast<const FoundField*>(heating.field.get());
  if (!found || !found->points) return;
  const PointHeat& points = found->points->points;
  const auto count = [](uint64_t n) { return human_count(static_cast<double>(n)); };
  for (const Diagnostic& d : points.diagnostics()) emit(d);
  if (points.asked() == 0) return;
  note(strf("heat: the temperatures of %s points took %.1f s of all threads together, %.0f us each",
            count(points.asked()).c_str(), points.seconds(),
            1e6 * points.seconds() / static_cast<double>(points.asked())));
}

namespace {

// s of one thread at work that tracing takes: a few faces, spread over all, are traced.
double seconds_of(const PreparedHeat& p, const Simulation& sim, const Scene& scene) {
  constexpr size_t kLooks = 4;
  const WeatherLoads weather = weather_loads(weather_of(sim, scene), p.spec);
  const PathOptions paths = path_options(p.spec);
  const size_t n = p.faces->size();
  // Waves are traced by one thread each.
  const auto seconds = [&](size_t together, const std::function<void(FaceRange)>& trace) {
    const size_t waves = (n + together - 1) / together, looks = std::min(kLooks, waves);
    size_t faces = 0;
    const std::clock_t begun = std::clock();
    for (size_t k = 0; k < looks; ++k) {
      const size_t begin = waves * k / looks * together, end = std::min(n, begin + together);
      trace({begin, end}), faces += end - begin;
    }
    return static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC * static_cast<double>(n) /
           static_cast<double>(faces);
  };
  ExchangePaths exchange = untraced_exchange(*p.elements, *p.faces, paths);
  Sunlight sun = untraced_sunlight(*p.elements, *p.faces, weather.course, paths);
  const double infrared = seconds(ExchangePaths::kTogether, [&](FaceRange r) {
    trace_exchange(*p.tracer, *p.elements, *p.faces, p.optics, paths, r, exchange);
  });
  const double more =
      p.elements->rests().empty() ? 0 : seeing_changes(p) * static_cast<double>(p.elements->rests().size() - 1);
  return (1 + more) * infrared + (1 + 0.7 * more) * seconds(Sunlight::kTogether, [&](FaceRange r) {
                                   for (const SunStage stage : {SunStage::straight, SunStage::scattered})
                                     trace_sunlight(*p.tracer, *p.elements, *p.faces, p.optics, weather.course, paths,
                                                    kSunJoins, stage, r, sun);
                                 });
}

std::string forecast(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& job,
                     const RenderOptions& options) {
  if (!asks_heat(*scene, sim, options)) return {};
  if (!options.heat.empty()) {  // it is read as the run does
    heating_of(scene, sim, job, options, "", nullptr);
    return {};
  }
  if (!options.heat_operator.empty()) operator_cut(options.heat_operator);  // it can be read
  const PreparedHeat p = prepare(scene, sim, {});
  const double faces = static_cast<double>(p.faces->size());
  // A face's path has a few surfaces; sunlight asks for the sun at each, and from a point for every eight paths at half
  // of the moments straight, and as often again where edges of shadows are.
  const double points = 1.0 * HeatSpec::kBlocks * points_of_beam(path_options(p.spec));
  const double later = static_cast<double>(std::max<size_t>(1, p.elements->rests().size()) - 1),
               seeing = later > 0 ? seeing_changes(p) : 0, more = seeing * later;
  const double rays = faces * ((1 + more) * p.spec.paths * (2 + 2 + 4 * 1.5) + points * moments_of(p));
  check_size(p, sim);
  const double seconds = seconds_of(p, sim, *scene);
  return strf(
             "heat: %zu elements (%zu faces, %.3g m2 at most), %u paths of each, %.0f moments, some %s rays, some %s\n",
             p.elements->size(), p.faces->size(), p.elements->largest(), p.spec.paths, moments_of(p),
             human_count(rays).c_str(), human_bytes(bytes_of(p)).c_str()) +
         strf(
             "heat: some %.1f s for the rays with %d threads at work, as long to twice as long again for the balance\n",
             seconds / threads(), threads()) +
         (later > 0
              ? strf("heat: %.0f intervals of rest; some %.2g %% of the faces see what changes, and are traced in "
                     "each\n",
                     later + 1, 100 * seeing)
              : std::string{}) +
         (p.spec.target > 0
              ? strf("heat: that is with %u paths of a face; target_error_k asks a pilot for their number\n",
                     p.spec.paths)
              : std::string{});
}

}  // namespace

std::string heat_forecast(const std::shared_ptr<const Scene>& scene, const Simulation& sim, const JobOptions& job,
                          const RenderOptions& options) {
  try {
    return forecast(scene, sim, job, options);
  } catch (const Error& e) {
    throw at_heat(e, sim);
  }
}

}  // namespace suite
