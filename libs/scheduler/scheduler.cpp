#include "scheduler/scheduler.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/progress.h"
#include "scheduler/capture_run.h"
#include "scheduler/order.h"
#include "scheduler/plan.h"
#include "scheduler/result.h"
#include "surface/cut_out.h"

namespace suite {

namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

// Materials that geometry or the Earth can show; the others are never baked.
std::vector<bool> shown_materials(const Scene& scene, const Tracer& tracer, const SourceSpecs& sources) {
  std::vector<bool> used = used_materials(scene, tracer.objects());
  if (sources.earth) used[earth_material(*sources.earth, scene)] = true;
  return used;
}

// Everything that belongs to one spectral state; kept while captures ask for the same one.
struct StateKit {
  Optics optics;
  Environment environment;
  BandProjection projection;
  size_t reference_band = 0;
  std::shared_ptr<const Tracer> lamps_of;  // whose geometry the environment was made for

  StateKit(const Scene& scene, const Tracer& tracer, const SourceSpecs& sources, const SpectralState& state,
           bool periodic, std::span<const Band> bands, TimeSpan window)
      : optics(scene, state, shown_materials(scene, tracer, sources), {}, window),
        environment(bake_environment(sources, tracer, periodic, state)),
        projection(state, bands) {
    for (size_t b = 0; b < bands.size(); ++b)
      if (std::fabs(bands[b].center_um - state.reference_um) <
          std::fabs(bands[reference_band].center_um - state.reference_um))
        reference_band = b;
  }
};

bool same_state(const SpectralState& a, const SpectralState& b) {
  auto same_bin = [](const Bin& x, const Bin& y) { return x.low_um == y.low_um && x.high_um == y.high_um; };
  return a.reference_um == b.reference_um && a.knots == b.knots && a.bins.size() == b.bins.size() &&
         std::equal(a.bins.begin(), a.bins.end(), b.bins.begin(), b.bins.end(), same_bin);
}

// A capture of the job and what it needs.
struct Item {
  size_t sensor, task, capture, id;
  StatePair state;
};

// moves: something in the scene does, so that windows differ.
std::vector<Item> items_of(std::span<const std::unique_ptr<Sensor>> sensors, bool moves) {
  std::vector<Item> items;
  std::map<std::pair<double, double>, size_t> windows;
  std::vector<const SpectralState*> distinct;
  for (size_t s = 0; s < sensors.size(); ++s) {
    std::vector<size_t> number;  // of each of the sensor's states
    for (const SpectralState& state : sensors[s]->states()) {
      const auto known =
          std::find_if(distinct.begin(), distinct.end(), [&](const SpectralState* d) { return same_state(*d, state); });
      number.push_back(static_cast<size_t>(known - distinct.begin()));
      if (known == distinct.end()) distinct.push_back(&state);
    }
    for (size_t t = 0; t < sensors[s]->tasks().size(); ++t)
      for (size_t c = 0; c < sensors[s]->tasks()[t].captures.size(); ++c) {
        const Capture& capture = sensors[s]->tasks()[t].captures[c];
        const size_t window =
            moves ? windows.try_emplace({capture.window.begin, capture.window.end}, windows.size()).first->second : 0;
        items.push_back({s, t, c, items.size(), {window, number[capture.state]}});
      }
  }
  return items;
}

std::vector<Item> in_cheapest_order(const std::vector<Item>& items, size_t& changes) {
  std::vector<StatePair> pairs;
  for (const Item& i : items) pairs.push_back(i.state);
  std::vector<Item> ordered;
  std::vector<StatePair> sequence;
  for (const size_t i : cheapest_order(pairs)) ordered.push_back(items[i]), sequence.push_back(items[i].state);
  changes = state_changes(sequence);
  return ordered;
}

// One run of all captures: what changes from capture to capture.
class Job {
 public:
  Job(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
      std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options)
      : scene_(scene), sources_(sources), sensors_(sensors), options_(options) {}

  JobReport run() {
    const std::vector<Item> items =
        in_cheapest_order(items_of(sensors_, !scene_->tracks.empty()), report_.state_changes);
    for (const Item& item : items) {
      const TimeWindow& w = capture_of(item).window;
      check_temperatures(*scene_, w.begin, w.end);
      window_ = &item == items.data() ? TimeSpan{w.begin, w.end}
                                      : TimeSpan{std::min(window_.begin, w.begin), std::max(window_.end, w.end)};
    }
    tracers_ = std::make_unique<TracerCache>(scene_, options_.periodic, cut_out(*scene_));
    if (!items.empty()) tracer_of(capture_of(items.front()));
    report_.build_seconds = seconds_since(start_);
    if (options_.store) options_.store->begin(shapes(items));
    if (options_.store && options_.begun) options_.begun(stored_work(items));
    report_.captures_asked = items.size();
    for (const Item& item : items) total_problems_ += static_cast<double>(capture_of(item).problems());
    if (options_.progress)
      progress_ = std::make_unique<Progress>("rendering", forecast_paths(sensors_, options_), "path");
    try {
      for (const Item& item : items) run_item(item);
    } catch (const Stopped&) {
      report_.stopped = true;
    }
    if (progress_) progress_->finish();
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

  StateKit& kit_of(const Item& item, CaptureLog& log) {
    const size_t state = capture_of(item).state;
    std::unique_ptr<StateKit>& kit = kits_[{item.sensor, state}];
    if (!kit) {
      kit = std::make_unique<StateKit>(*scene_, *tracer_, sources_, sensors_[item.sensor]->states()[state],
                                       options_.periodic.has_value(), sensors_[item.sensor]->bands(state), window_);
      ++report_.optics_bakes;
      log.new_optics = true;
    }
    // Glowing geometry has its places in the tracer.
    if (kit->environment.lamps && kit->lamps_of != tracer_)
      kit->environment = bake_environment(sources_, *tracer_, options_.periodic.has_value(), kit->optics.state());
    kit->lamps_of = tracer_;
    return *kit;
  }

  void run_item(const Item& item) {
    const Clock::time_point begun = Clock::now();
    const Sensor& sensor = *sensors_[item.sensor];
    const Capture& capture = capture_of(item);
    CaptureLog log;
    log.new_tracer = tracer_of(capture);
    StateKit& kit = kit_of(item, log);
    if (capture.bin_by == Capture::BinBy::sun && (!kit.optics.media().empty() || kit.environment.atmosphere))
      throw Error("sensor '" + sensor.name() + "' asks for many suns at once, which do not shine through media or air");
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
    ResultBuilder builder(capture, bands, channels, kit.reference_band, truth);
    sensors_[item.sensor]->begin(capture);
    try {
      run_capture(work, bands * channels * capture.bins, truth.slots(), builder, log.statistics);
    } catch (const Stopped&) {
      report_.statistics.merge(log.statistics);
      throw;
    }
    CaptureResult result = builder.finish();
    result.task = item.task;
    result.capture = item.capture;
    judge(item, work, kit, result, log);
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
    sensors_[item.sensor]->accept(std::move(result));
    report_.deliver_seconds += seconds_since(handed);
  }

  // The bands that decide, and how much stricter than theirs the strictest target is.
  std::vector<JudgedBand> judged_bands(const Capture& capture, const StateKit& kit) const {
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

  void judge(const Item& item, const CaptureWork& work, const StateKit& kit, const CaptureResult& r, CaptureLog& log) {
    const size_t values = r.values_per_problem();
    ErrorHistogram errors;
    for (size_t i = 0; i < work.capture.problems(); ++i) {
      flagged_ += r.quality[i] & quality_heavy_tail ? 1 : 0;
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
    report_.median_relative_error = errors_.median();
    report_.share_in_embree = report_.statistics.cycles ? static_cast<double>(report_.statistics.trace.cycles) /
                                                              static_cast<double>(report_.statistics.cycles)
                                                        : 0;
    report_.seconds = seconds_since(start_);
    if (with_target_ > 0) report_.share_at_target = at_target_ / with_target_;
    if (report_.problems) report_.share_flagged = flagged_ / static_cast<double>(report_.problems);
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
  std::map<std::pair<size_t, size_t>, std::unique_ptr<StateKit>> kits_;
  ErrorHistogram errors_;
  double total_problems_ = 0, with_target_ = 0, at_target_ = 0, at_maximum_ = 0, flagged_ = 0, target_ = 0;
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
        most = std::max(most, static_cast<double>(c.problems()) * ((scrambles + 2) * bands * 8 + 200));
      }
  return most;
}

JobOrder order_of(std::span<const std::unique_ptr<Sensor>> sensors, bool moves) {
  JobOrder order;
  for (const Item& i : in_cheapest_order(items_of(sensors, moves), order.state_changes)) order.captures.push_back(i.id);
  return order;
}

JobReport run_job(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
                  std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  return Job(scene, sources, sensors, options).run();
}

}  // namespace suite
