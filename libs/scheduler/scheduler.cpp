#include "scheduler/scheduler.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "base/progress.h"
#include "scheduler/capture_run.h"
#include "scheduler/items.h"
#include "scheduler/kits.h"
#include "scheduler/plan.h"
#include "scheduler/result.h"
#include "surface/cut_out.h"

namespace suite {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

// One run of all captures: what changes from capture to capture.
class Job {
 public:
  Job(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
      std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options)
      : scene_(scene), sources_(sources), sensors_(sensors), options_(options) {
    for (const auto& sensor : sensors) report_.shortfalls.push_back({sensor->name(), {}});
  }

  JobReport run() {
    const std::vector<Item> items =
        in_cheapest_order(items_of(sensors_, !scene_->tracks.empty()), sources_.dated(), report_.state_changes);
    for (const Item& item : items) {
      const TimeWindow& w = capture_of(item).window;
      check_temperatures(*scene_, w.begin, w.end);
      window_ = &item == items.data() ? TimeSpan{w.begin, w.end}
                                      : TimeSpan{std::min(window_.begin, w.begin), std::max(window_.end, w.end)};
    }
    tracers_ = std::make_unique<TracerCache>(scene_, options_.periodic, cut_out(*scene_));
    kits_ = std::make_unique<Kits>(*scene_, sources_, options_.periodic.has_value(), window_);
    for (const Item& item : items) kits_->expect(item.state.spectral);
    if (!items.empty()) tracer_of(capture_of(items.front()));
    report_.build_seconds = seconds_since(start_);
    doubt_before();
    if (options_.store) options_.store->begin(shapes(items));
    if (options_.store && options_.begun) options_.begun(stored_work(items));
    report_.captures_asked = items.size();
    for (const Item& item : items) total_problems_ += static_cast<double>(capture_of(item).problems());
    if (options_.progress)
      progress_ = std::make_unique<Progress>("rendering", forecast_paths(sensors_, options_), "path");
    for (const auto& sensor : sensors_) report_.quality.push_back({sensor->name(), {}});
    try {
      for (const Item& item : items) run_item(item);
    } catch (const Stopped&) {
      report_.stopped = true;
    }
    if (progress_) progress_->finish();
    if (!report_.stopped) doubt_after();
    finish();
    return std::move(report_);
  }

 private:
  const Capture& capture_of(const Item& item) const {
    return sensors_[item.sensor]->tasks()[item.task].captures[item.capture];
  }

  // The budget, with a time budget turned into a maximum of paths as soon as that is known.
  Budget budget() const {
    Budget b = options_.budget;
    if (b.seconds <= 0) return b;
    b.max_paths = cap_ ? cap_ : b.max_paths.value_or(kDefaultMost);
    return b;
  }

  // Makes the tracer of a capture's time window the current one; true when it had to be built.
  bool tracer_of(const Capture& capture) {
    const size_t before = tracers_->builds();
    tracer_ = tracers_->get({capture.window.begin, capture.window.end});
    report_.tracer_builds = tracers_->builds();
    return tracers_->builds() > before;
  }

  // Each sensor is doubted once: what was said before rendering explains what comes out.
  void doubt_before() {
    outcomes_.resize(sensors_.size());
    if (!options_.doubt || !tracer_) return;
    const auto say = [&](const std::vector<Doubt>& doubts) {
      for (const Doubt& d : doubts)
        if (!d.useless || doubted_.insert(d.sensor).second) options_.doubt(d);
    };
    say(doubts_of_view(*tracer_, sources_, sensors_));
    say(doubts_of_light(sources_, *scene_, sensors_));
  }

  void doubt_after() {
    for (size_t s = 0; options_.doubt && s < sensors_.size(); ++s)
      if (!doubted_.contains(sensors_[s]->name()))
        if (const auto doubt = doubt_of_outcome(*sensors_[s], outcomes_[s], !options_.store)) options_.doubt(*doubt);
  }

  // What the store has to hold of each capture, by number.
  std::vector<CaptureShape> shapes(const std::vector<Item>& items) const {
    std::vector<CaptureShape> all(items.size());
    std::map<std::pair<size_t, size_t>, size_t> slots;  // of truth, by sensor and state
    for (const Item& item : items) {
      const Sensor& sensor = *sensors_[item.sensor];
      const Capture& capture = capture_of(item);
      const auto [known, fresh] = slots.try_emplace({item.sensor, capture.state}, 0);
      if (fresh) {
        const SpectralState& state = sensor.states()[capture.state];
        const BandProjection projection(state, sensor.bands(capture.state));
        const Environment none;
        known->second =
            TruthPlan(sensor.truth(), {*tracer_, state, capture.state, sensor.bands(capture.state), projection, none})
                .slots();
      }
      all[item.id] = {capture.columns, capture.rows,
                      sensor.bands(capture.state).size() * sensor.channels().size() * capture.bins,
                      Accumulators::scrambles_for(goals_of(sensor, capture, budget()).all.max_paths), known->second};
    }
    return all;
  }

  // How far the store has each capture.
  StoredWork stored_work(const std::vector<Item>& items) {
    StoredWork work{items.size(), 0, 0};
    if (!cap_) cap_ = options_.store->cap();
    for (const Item& item : items) {
      std::vector<uint32_t> paths;
      std::vector<double> needs;
      options_.store->load_paths(item.id, paths, needs);
      const Capture& capture = capture_of(item);
      const Goals goals = goals_of(*sensors_[item.sensor], capture, budget());
      const bool piloted = goals.all.relative_error > 0 || (options_.budget.seconds > 0 && !cap_);
      const std::vector<uint32_t> plan = plan_of(capture, goals, piloted ? needs : std::vector<double>{});
      work.finished += (!piloted || !needs.empty()) && std::equal(paths.begin(), paths.end(), plan.begin(),
                                                                  [](uint32_t a, uint32_t b) { return a >= b; });
      for (const uint32_t p : paths) work.paths += p;
    }
    return work;
  }

  void warn_of_lost_light(const Sensor& sensor, const Capture& capture, const Kit& kit) {
    if (!options_.warn) return;
    const uint32_t paths = goals_of(sensor, capture, budget()).all.max_paths;
    for (const std::string& s : lost_light(*scene_, sources_, kit.optics, options_.pipeline, paths))
      if (told_.insert(s).second) options_.warn(s);
  }

  void run_item(const Item& item) {
    const Clock::time_point begun = Clock::now();
    const Sensor& sensor = *sensors_[item.sensor];
    const Capture& capture = capture_of(item);
    CaptureLog log;
    log.new_tracer = tracer_of(capture);
    const size_t bakes = kits_->optics_bakes();
    const Kit kit = kits_->get(item.state.spectral, sensor, capture, tracer_);
    log.new_optics = kits_->optics_bakes() > bakes;
    if (capture.bin_by == Capture::BinBy::sun && (!kit.optics.media().empty() || kit.environment.atmosphere))
      throw Error("sensor '" + sensor.name() + "' asks for many suns at once, which do not shine through media or air");
    warn_of_lost_light(sensor, capture, kit);
    const Surface surface(*tracer_, kit.optics);
    const TruthPlan truth(sensor.truth(), {*tracer_, kit.optics.state(), capture.state, sensor.bands(capture.state),
                                           kit.projection, kit.environment});
    const Pipeline pipeline(surface, kit.optics, kit.environment, kit.optics.state(), kit.projection,
                            kit.reference_band, truth, options_.pipeline);
    if (options_.store && !cap_) cap_ = options_.store->cap();
    CaptureWork work{pipeline,
                     sensor,
                     capture,
                     item.id,
                     goals_of(sensor, capture, budget()),
                     judged_bands(capture, kit),
                     options_.store,
                     progress_.get(),
                     {},
                     options_.stop};
    if (options_.budget.seconds > 0 && !cap_)
      work.after_pilot = [this](CaptureWork& w, std::span<const double> needs, double paths, double seconds) {
        fix_cap(w, needs, paths, seconds);
      };
    if (work.after_pilot) shorten_pilots(work.goals);
    const size_t bands = kit.projection.bands(), channels = sensor.channels().size();
    ResultBuilder builder(capture, bands, channels, kit.reference_band, truth, work.goals);
    sensors_[item.sensor]->begin(capture);
    try {
      run_capture(work, bands * channels * capture.bins, truth.slots(), builder, log.statistics);
    } catch (const Stopped&) {
      report_.statistics.merge(log.statistics);
      throw;
    }
    CaptureResult result = builder.finish();
    report_.shortfalls[item.sensor].shortfall.merge(builder.shortfall());
    result.task = item.task;
    result.capture = item.capture;
    judge(item, work, kit, result, log);
    outcomes_[item.sensor].add(sensor.bands(capture.state), result, log.statistics);
    if (item.task == 0 && item.capture == 0)
      outcomes_[item.sensor].looks_down = middle_ray(sensor, capture, capture.problems() / 2).ray.direction.z < 0;
    log.sensor = sensor.name();
    log.task = sensor.tasks()[item.task].name;
    log.capture = capture.name;
    log.state = kit.optics.state().text();
    log.kernel = pipeline.kernel();
    log.id = item.id;
    log.window = capture.window;
    log.problems = capture.problems();
    log.seconds = seconds_since(begun);
    report_.statistics.merge(log.statistics);
    ++report_.captures;
    report_.problems += capture.problems();
    report_.log.push_back(std::move(log));
    const Clock::time_point handed = Clock::now();
    kits_->done(item.state.spectral);
    sensors_[item.sensor]->accept(std::move(result));
    report_.deliver_seconds += seconds_since(handed);
  }

  // The bands that decide, and how much stricter than theirs the strictest target is.
  std::vector<JudgedBand> judged_bands(const Capture& capture, const Kit& kit) const {
    const std::vector<double>& targets = capture.band_targets;
    if (targets.empty() && !options_.budget.all_bands) return {{kit.reference_band}};
    std::vector<JudgedBand> judged;
    for (size_t b = 0; b < kit.projection.bands(); ++b) {
      const double target = b < targets.size() ? targets[b] : 0;
      if (options_.budget.all_bands)
        judged.push_back({b});
      else if (target > 0)
        judged.push_back({b, std::pow(capture.convergence.relative_error / target, 2)});
    }
    return judged;
  }

  // With a time budget, fixed counts too begin with a pilot.
  static void shorten_pilots(Goals& goals) {
    auto shorten = [](Convergence& goal) {
      if (goal.relative_error == 0) goal.min_paths = std::min(kDefaultPilot, goal.max_paths);
    };
    shorten(goals.all);
    for (Convergence& goal : goals.own) {
      shorten(goal);
      goals.all.min_paths = std::min(goals.all.min_paths, goal.min_paths);
    }
  }

  // Turns the time that is left into a maximum of paths, the same for all captures, so that the run can be repeated.
  void fix_cap(CaptureWork& work, std::span<const double> needs, double paths, double seconds) {
    const double left = options_.budget.seconds - seconds_since(start_), rate = seconds > 0 ? paths / seconds : 0;
    const double here = static_cast<double>(work.capture.problems());
    // Each capture gets its share of what can be traced in the time that is left, counting the pilot that this one has.
    const double total = here / total_problems_ * (std::max(0.0, left) * rate + paths);
    cap_ = cap_for_total(needs, work.goals,
                         work.goals.all.relative_error > 0 ? total : std::floor(total / here / 4) * 4 * here);
    work.goals.all.max_paths = report_.time_cap = cap_;
    if (options_.store) options_.store->save_cap(cap_);
  }

  void judge(const Item& item, const CaptureWork& work, const Kit& kit, const CaptureResult& r, CaptureLog& log) {
    const size_t values = r.values_per_problem();
    report_.quality[item.sensor].counts.add(r.quality);
    ErrorHistogram errors;
    for (size_t i = 0; i < work.capture.problems(); ++i) {
      if (const double mean = r.radiance[i * values + kit.reference_band]; mean > 0)
        errors.add(r.standard_error[i * values + kit.reference_band] / mean);
      double worst = 0;
      const Convergence goal = work.goals.of(i);
      for (const auto [b, weight] : work.judged) {
        const double scale = std::max(r.radiance[i * values + b], goal.absolute_floor);
        if (scale > 0) worst = std::max(worst, std::sqrt(weight) * r.standard_error[i * values + b] / scale);
      }
      if (worst > report_.worst.relative_error)
        report_.worst = {sensors_[item.sensor]->name(), work.capture.name,
                         static_cast<uint32_t>(i % work.capture.columns),
                         static_cast<uint32_t>(i / work.capture.columns), worst};
      if (!(goal.relative_error > 0)) continue;
      with_target_ += 1;
      at_target_ += worst <= goal.relative_error ? 1 : 0;
      at_maximum_ += r.paths[i] >= goal.max_paths ? 1 : 0;
      target_ = std::max(target_, goal.relative_error);
    }
    log.median_relative_error = errors.median();
    errors_.merge(errors);
  }

  void finish() {
    report_.optics_bakes = kits_->optics_bakes(), report_.light_bakes = kits_->light_bakes();
    report_.median_relative_error = errors_.median();
    report_.share_in_embree = report_.statistics.cycles ? static_cast<double>(report_.statistics.trace.cycles) /
                                                              static_cast<double>(report_.statistics.cycles)
                                                        : 0;
    report_.seconds = seconds_since(start_);
    if (with_target_ > 0) report_.share_at_target = at_target_ / with_target_;
    for (const auto& [sensor, counts] : report_.quality)
      if (counts.problems)
        report_.share_flagged +=
            static_cast<double>(counts.with(quality_heavy_tail)) / static_cast<double>(report_.problems);
    std::string& s = report_.stopped_by;
    if (report_.stopped)
      s = strf("stopped from outside after %zu of %zu captures", report_.captures, report_.captures_asked);
    else if (options_.pipeline.stop == StopRule::change)
      s = strf(
          "each problem stopped when one more path changed its mean by less than %g of it, which is biased low where "
          "rare events carry the light",
          options_.pipeline.change);
    else if (with_target_ > 0)
      s = strf(
          "stopped by the plan for a target of %g %%, or by its maximum of paths (%.1f %% of the problems); %.1f %% of "
          "the problems are at the target",
          100 * target_, 100 * at_maximum_ / with_target_, 100 * report_.share_at_target);
    else
      s = "every problem ran the paths it was given";
    if (report_.time_cap)
      s += strf("; the time was worth %u paths a problem (--paths %u repeats this run)", report_.time_cap,
                report_.time_cap);
    else if (cap_)
      s += strf("; at most %u paths a problem, as the time was found to be worth", cap_);
    const WorstProblem& w = report_.worst;
    if (w.relative_error > 0)
      s += strf("; the worst is column %u, row %u of '%s' with %.2g %%", w.column, w.row, w.capture.c_str(),
                100 * w.relative_error);
  }

  std::shared_ptr<const Scene> scene_;
  const SourceSpecs& sources_;
  std::span<const std::unique_ptr<Sensor>> sensors_;
  const JobOptions& options_;
  Clock::time_point start_ = Clock::now();
  JobReport report_;
  std::unique_ptr<TracerCache> tracers_;
  std::shared_ptr<const Tracer> tracer_;  // of the capture that runs
  std::unique_ptr<Progress> progress_;
  TimeSpan window_;  // of all captures
  std::unique_ptr<Kits> kits_;
  std::vector<SensorOutcome> outcomes_;  // of each sensor
  std::set<std::string> doubted_;        // sensors
  ErrorHistogram errors_;
  std::set<std::string> told_;
  double total_problems_ = 0, with_target_ = 0, at_target_ = 0, at_maximum_ = 0, target_ = 0;
  uint32_t cap_ = 0;
};

}  // namespace

double forecast_paths(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  double sum = 0;
  for (const auto& s : sensors)
    for (const Task& t : s->tasks())
      for (const Capture& c : t.captures) {
        const Goals goals = goals_of(*s, c, options.budget);
        auto least = [](const Convergence& goal) {
          return static_cast<double>(goal.relative_error > 0 ? goal.min_paths : goal.max_paths);
        };
        if (goals.own.empty()) sum += static_cast<double>(c.problems()) * least(goals.all);
        for (const Convergence& goal : goals.own) sum += least(goal);
      }
  return sum;
}

double forecast_bytes(std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  double most = 0;
  for (const auto& s : sensors)
    for (const Task& t : s->tasks())
      for (const Capture& c : t.captures) {
        const double scrambles = Accumulators::scrambles_for(goals_of(*s, c, options.budget).all.max_paths),
                     bands = static_cast<double>(s->bands(c.state).size());
        most = std::max(most, static_cast<double>(c.problems()) * ((scrambles + 3) * bands * 8 + 300));
      }
  return most;
}

JobOrder order_of(std::span<const std::unique_ptr<Sensor>> sensors, bool moves, bool dated) {
  JobOrder order;
  for (const Item& i : in_cheapest_order(items_of(sensors, moves), dated, order.state_changes))
    order.captures.push_back(i.id);
  return order;
}

JobReport run_job(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
                  std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  return Job(scene, sources, sensors, options).run();
}

}  // namespace suite
