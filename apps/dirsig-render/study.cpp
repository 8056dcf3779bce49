#include "study.h"

#include <chrono>
#include <cmath>

#include "base/files.h"
#include "base/inputs.h"
#include "base/outputs.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "continued.h"
#include "formats/envi/envi.h"
#include "log.h"
#include "scheduler/result.h"
#include "sensor/quality.h"
#include "start.h"
#include "study/study.h"
#include "trace/tracer.h"

namespace suite {

namespace {

constexpr const char* kUnits = "W/(m2 sr um)";

// A reference of many captures is kept as one line of pixels, a band a series.
void write_reference(const std::string& path, const StudyImage& image, bool errors) {
  EnviHeader h;
  h.samples = image.series.at(0).radiance.size();
  h.lines = 1;
  h.bands = image.series.size();
  h.type = EnviType::float64;
  h.data_units = kUnits;
  h.description = errors ? "standard error of the reference of a study" : "reference of a study";
  std::vector<double> values(h.values());
  for (size_t b = 0; b < h.bands; ++b) {
    h.band_names.push_back(strf("series %zu", b));
    const std::vector<double>& from = errors ? image.series[b].standard_error : image.series[b].radiance;
    if (from.size() != h.samples)
      throw Error("the sensors of this simulation have bands of different numbers of pixels", "study them one by one");
    for (size_t i = 0; i < h.samples; ++i) values[i * h.bands + b] = from[i];
  }
  write_envi(path, h, values);
}

// bands x pixels as the simulation will give them; errors: read into standard_error.
void read_series(const std::string& path, StudyImage& image, bool errors, size_t pixels, size_t bands) {
  const EnviImage file(path);
  file.require_units(kUnits);
  const EnviHeader& h = file.header();
  const Where where{path, 0, 0, {}, -1};
  if (h.bands != bands)
    throw Error(where, strf("the reference has %zu bands, the simulation gives %zu", h.bands, bands));
  if (h.samples * h.lines != pixels)
    throw Error(
        where, strf("the reference has %zu x %zu pixels, the simulation gives %zu in all", h.samples, h.lines, pixels));
  const std::vector<double> values = file.read_all();
  image.series.resize(bands);
  for (size_t b = 0; b < bands; ++b) {
    std::vector<double>& to = errors ? image.series[b].standard_error : image.series[b].radiance;
    to.resize(pixels);
    for (size_t i = 0; i < pixels; ++i) to[i] = values[i * bands + b];
  }
}

struct Size {
  size_t pixels = 0, bands = 0;
};
Size size_of(const Simulation& sim) {
  Size size;
  const Where where = sim.sensor_where.empty() ? Where{sim.path, 0, 0, {}, -1} : sim.sensor_where.back();
  for (const auto& sensor : sim.sensors)
    for (const Task& t : sensor->tasks())
      for (const Capture& c : t.captures) {
        const bool cells = c.bin_by == Capture::BinBy::escape;
        const size_t bands = sensor->bands(c.state).size() * (cells ? 1 : c.bins);
        if (size.bands && bands != size.bands)
          throw Error(where, "a study wants captures of the same number of bands", "study the sensors one by one");
        size = {size.pixels + c.problems() * (cells ? c.bins : 1), bands};
      }
  if (sim.sensors.size() > 1) throw Error(where, "a study wants one sensor", "study the sensors one by one");
  if (!size.pixels) throw Error(where, "the simulation has no pixels to study");
  return size;
}

std::string identity_of(const RenderOptions& o, const Simulation& sim, const JobOptions& options) {
  auto hash = [](const std::string& path) { return sha256(read_bytes(path, size_t{1} << 40)).substr(0, 16); };
  return strf("scene %s simulation %s build %s reference %s stop %s%s threads %d engine %s",
              hash(sim.scene_path).c_str(), hash_of_text(sim).substr(0, 16).c_str(), hash("/proc/self/exe").c_str(),
              o.reference.empty() ? "long-run" : hash(o.reference).c_str(),
              options.pipeline.stop == StopRule::change ? "change" : "plan",
              options.pipeline.method == Method::paper ? " method paper" : "", threads(), Tracer::engine().c_str());
}

// Runs the simulation into an image of its own.
StudyOutput run_once(const std::shared_ptr<const Scene>& scene, const Simulation& sim, JobOptions options,
                     const StudyRun& run, StudyImage*& collect) {
  StudyOutput out;
  options.progress = false;
  options.budget = run.budget;
  options.pipeline.seed = run.seed;
  if (run.reference) options.pipeline.stop = StopRule::plan, options.pipeline.method = Method::standard;
  collect = &out.image;
  start_sensors(sim, options, "");
  out.report = run_job(scene, sim.sources, sim.sensors, options);
  collect = nullptr;
  out.file_seconds = out.report.deliver_seconds;
  out.peak_bytes = peak_bytes();
  return out;
}

// Given, kept from an earlier study, or a long run.
StudyImage reference_for(const RenderOptions& o, const std::shared_ptr<const Scene>& scene, const Simulation& sim,
                         const JobOptions& options, const StudyPlan& plan, bool kept, StudyImage*& collect) {
  const Size size = size_of(sim);
  StudyImage image;
  const std::string file = in_folder(o.study, "reference.img"), errors = in_folder(o.study, "reference_error.img");
  if (!o.reference.empty()) {
    read_series(o.reference, image, false, size.pixels, size.bands);
    return image;
  }
  if (kept && file_exists(file) && file_exists(errors)) {
    const OwnResults own;
    read_series(file, image, false, size.pixels, size.bands);
    read_series(errors, image, true, size.pixels, size.bands);
    image.degrees = error_degrees(sim.sensors[0]->tasks()[0].captures[0], UINT32_MAX);
    note("the reference is kept from before");
    return image;
  }
  note(strf("making a reference with %g times the largest budget and other seeds", StudyPlan::kReferenceFactor));
  StudyOutput run = run_once(scene, sim, options, reference_run(plan), collect);
  write_reference(file, run.image, false);
  write_reference(errors, run.image, true);
  note(strf("reference: %s paths in %s", human_count(static_cast<double>(run.report.statistics.paths)).c_str(),
            human_seconds(run.report.seconds).c_str()));
  return std::move(run.image);
}

void report_summary(const StudySummary& s) {
  for (const StudySeries& series : s.series) {
    const StudyPoint& last = series.points.back();
    std::printf(
        "%s: %.3g %% at %g %s (%.3g s), slope %.3f (%.3f) against seconds, %.3f (%.3f) against paths, coverage %.1f "
        "%%\n",
        series.name.c_str(), 100 * last.rmse, last.budget, series.by_time ? "s" : "paths", last.seconds,
        series.slope_seconds, series.slope_seconds_error, series.slope_paths, series.slope_paths_error,
        100 * last.coverage);
    const std::string found =
        std::isnan(last.found_share) ? "" : strf(", %.4g %% of these are flagged", 100 * last.found_share);
    std::printf(
        "  flagged %.3g %%; beyond %g standard errors by more than %g %% of radiance: %.3g %%%s; flagged but not: "
        "%.3g %%\n",
        100 * last.flagged_share, kTailFactor, 100 * kTailShare, 100 * last.exceeding_share, found.c_str(),
        100 * last.false_share);
  }
  std::printf("bias: smallest p of %zu tests %.3g: %s at 1 %% family-wise\n", s.tests, s.smallest_p,
              s.unbiased ? "passes" : "FAILS");
}

}  // namespace

int run_study_command(const RenderOptions& o, const std::shared_ptr<const Scene>& scene, const Simulation& sim,
                      const JobOptions& options, StudyImage*& collect) {
  const StudyPlan plan = plan_of(o.study_budgets, o.study_seeds, options.pipeline.seed);
  if (scene->groups.empty() || scene->groups[0].placements.empty())
    throw Error(Where{sim.scene_path, 0, 0, {}, -1}, "the scene is empty: there is nothing to study");
  const Size size = size_of(sim);
  make_folder(o.study);
  const std::string table = in_folder(o.study, "study.csv"), identity = identity_of(o, sim, options);
  check_outputs({table, in_folder(o.study, "study.json"), in_folder(o.study, "study.html"),
                 in_folder(o.study, "reference.img"), in_folder(o.study, "reference_error.img")});
  const bool kept = file_exists(table);
  std::vector<StudyRow> rows;
  if (kept) {
    const OwnResults own;
    rows = rows_from_csv(read_text(table), identity, table);
  }
  write_file(table, rows_to_csv(rows, identity));  // an unwritable folder is refused before rendering
  note(strf("%zu budgets, %d seeds: %s %s", plan.budgets.size(), plan.seeds,
            human_count(forecast_paths_per_problem(plan, o.reference.empty()) *
                        (plan.by_time ? 1 : static_cast<double>(size.pixels)))
                .c_str(),
            plan.by_time ? "seconds" : "paths"));
  const StudyImage reference = reference_for(o, scene, sim, options, plan, kept, collect);
  const auto started = std::chrono::steady_clock::now();
  StudyTools tools;
  tools.run = [&](const StudyRun& run) { return run_once(scene, sim, options, run, collect); };
  tools.save = [&](const std::vector<StudyRow>& all) { write_file(table, rows_to_csv(all, identity)); };
  tools.progress = [&](double fraction, const std::string& what) {
    const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    note(strf("%3.0f %%: %s; about %s left", 100 * fraction, what.c_str(),
              human_seconds(spent * (1 - fraction) / fraction).c_str()));
  };
  run_study(plan, reference, tools, rows);
  const StudySummary summary = summarise(rows);
  write_file(in_folder(o.study, "study.json"), json_of(summary, rows).text());
  write_file(in_folder(o.study, "study.html"),
             html_of(page_of(summary, rows, "Error against run time: " + sim.path,
                             {command_line(), Tracer::engine() + strf(", %d threads", threads()),
                              o.reference.empty() ? strf("Reference: an independent run with %g times the largest "
                                                         "budget; its own error is part of every test.",
                                                         StudyPlan::kReferenceFactor)
                                                  : "Reference: " + o.reference + ", taken as exact."})));
  report_summary(summary);
  note("wrote " + in_folder(o.study, "study.csv, study.json, study.html"));
  return 0;
}

}  // namespace suite
