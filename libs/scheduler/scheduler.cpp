#include "scheduler/scheduler.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/stopwatch.h"
#include "estimate/plan.h"
#include "scheduler/forecast.h"
#include "scheduler/in_flight.h"
#include "scheduler/items.h"
#include "scheduler/judge.h"
#include "scheduler/kits.h"
#include "scheduler/planner.h"
#include "scheduler/points_in_view.h"
#include "scheduler/primed.h"
#include "scheduler/result.h"
#include "scheduler/stored.h"
#include "scheduler/surroundings.h"
#include "surface/cut_out.h"

namespace suite {

namespace {

// Captures whose rounds are run together: as many as keep many threads busy to the end, unless they take more memory.
constexpr size_t kBlocksInFlight = 1024;
constexpr size_t kPrimedInFlight = 16;  // each has working memory of its own
constexpr double kBytesInFlight = 256 << 20;
// A capture that may take more paths than this is delivered by itself, as soon as it is done.
constexpr double kPathsInFlight = 1 << 20;

// One run of all captures: what changes from capture to capture.
class Job {
 public:
  Job(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
      std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options)
      : scene_(scene), sources_(sources), sensors_(sensors), options_(options) {
    for (const Sensors all : {sensors_, options.prepasses})
      for (const auto& sensor : all)
        report_.shortfalls.push_back({sensor->name(), {}}), report_.quality.push_back({sensor->name(), {}});
    outcomes_.resize(report_.quality.size());
  }

  JobReport run() {
    try {
      run_captures();
    } catch (const Stopped&) {
      if (executor().processes() > 1) throw;  // they end together, by their executor alone
      report_.stopped = true;
    }
    if (progress_) progress_->finish();
    if (!report_.stopped && options_.store) options_.store->finish();
    if (!report_.stopped && !options_.share) diagnose_after();
    if (tracers_) report_.tiles = tracers_->tile_use();
    finish();
    return std::move(report_);
  }

 private:
  void run_captures() {
    const std::vector<Item> seen = items_from(sensors_, 0, 0),
                            before = items_from(options_.prepasses, sensors_.size(), seen.size());
    std::vector<Item> items = seen;
    items.insert(items.end(), before.begin(), before.end());
    report_.captures_asked = items.size();
    for (const Item& item : items)
      check_temperatures(*scene_, capture_of(item).window.begin, capture_of(item).window.end);
    tracers_ = std::make_unique<TracerCache>(scene_, options_.periodic, cut_out(*scene_), options_.tiles);
    if (!items.empty()) tracer_of(capture_of(items.front()));
    report_.build_seconds = seconds_since(start_);
    diagnose_before();
    if (options_.share) mine_ = blocks_of_share(sensors_, *options_.share);
    if (options_.store) begin_store(items);
    std::vector<SentRound> none;
    exchange(executor(), none, cap_);
    for (const Item& item : seen) total_problems_ += static_cast<double>(capture_of(item).problems());
    if (options_.progress) progress_ = begin_progress(sensors_, options_, seconds_since(start_));
    saving_.store = options_.store;
    if (!before.empty()) run_all(before, {.pending = true});
    report_.stopped = executor().any(report_.stopped);
    if (const std::vector<Item> some = of_share(seen); !some.empty() && !report_.stopped) run_all(some, heating());
  }
  // The captures of some sensors in the order in which they run, numbered from what is given.
  std::vector<Item> items_from(Sensors sensors, size_t sensor, size_t id) {
    size_t changes = 0;
    std::vector<Item> items = in_cheapest_order(items_of(sensors, changes_in_time(*scene_)), sources_.dated(), changes);
    report_.state_changes += changes;
    for (Item& i : items) i.sensor += sensor, i.id += id;
    return items;
  }

  // Runs captures with kits of their own.
  void run_all(std::span<const Item> items, const Heating& heating) {
    TimeSpan window{kEver, -kEver};
    for (const Item& item : items) window = hull(window, capture_of(item).window);
    primed_.clear();
    kits_ =
        std::make_unique<Kits>(*scene_, sources_, options_.periodic.has_value(), window, options_.kit_bytes, heating);
    for (const Item& item : items) kits_->expect(item.state.spectral);
    for (std::span<const Item> left = items; !left.empty() && !report_.stopped;) left = run_batch(left);
    report_.optics_bakes += kits_->optics_bakes(), report_.light_bakes += kits_->light_bakes();
  }

  Heating heating() const {
    Heating heating = options_.heating;
    if (options_.loads) heating.loads = options_.loads();
    return heating;
  }

  Executor& executor() { return options_.executor ? *options_.executor : local_; }
  // Of a job that several processes run together, pre-passes are run by each: all need what comes of them.
  bool together(const Item& item) { return !early(item) && executor().processes() > 1; }
  bool follows(const Item& item) { return together(item) && !executor().leads(); }

  bool early(const Item& item) const { return item.sensor >= sensors_.size(); }  // of a pre-pass
  Sensor& sensor_of(const Item& item) const {
    return early(item) ? *options_.prepasses[item.sensor - sensors_.size()] : *sensors_[item.sensor];
  }
  const Capture& capture_of(const Item& item) const {
    return sensor_of(item).tasks()[item.task].captures[item.capture];
  }

  // The budget, with a time budget turned into a maximum of paths as soon as that is known; none for pre-passes.
  Budget budget_of(const Item& item) const {
    if (early(item)) return {};
    Budget b = options_.budget;
    if (b.seconds <= 0) return b;
    b.max_paths = cap_ ? cap_ : b.max_paths.value_or(kDefaultMost);
    return b;
  }

  Goals goals_of(const Item& item) const { return suite::goals_of(sensor_of(item), capture_of(item), budget_of(item)); }

  // Whether the pilot of a capture has to tell what time is worth.
  bool unknown_cap(const Item& item) const { return options_.budget.seconds > 0 && !cap_ && !early(item); }

  // Makes the tracer of a capture's time window the current one; true when it had to be built.
  bool tracer_of(const Capture& capture) {
    const size_t before = tracers_->builds();
    tracer_ = tracers_->get({capture.window.begin, capture.window.end});
    report_.tracer_builds = tracers_->builds();
    return tracers_->builds() > before;
  }

  // One useless picture is reported once a sensor: what was said before rendering explains what comes out.
  void diagnose_before() {
    if (!options_.diagnose || !tracer_) return;
    const auto say = [&](const std::vector<SensorDiagnostic>& found) {
      for (const SensorDiagnostic& d : found)
        if (!d.useless || useless_.insert(d.sensor).second) options_.diagnose(d.diagnostic());
    };
    say(diagnose_views(*tracer_, sources_, sensors_));
    say(diagnose_lights(sources_, *scene_, sensors_));
  }

  void diagnose_after() {
    for (size_t s = 0; options_.diagnose && s < sensors_.size(); ++s)
      if (!useless_.contains(sensors_[s]->name()))
        if (const auto found = diagnose_outcome(*sensors_[s], outcomes_[s], !options_.store))
          options_.diagnose(found->diagnostic());
  }

  // Of a part of a job: the part's blocks of a capture of the sensors; empty = all of them.
  std::vector<uint8_t> mine_of(const Item& item) const {
    if (!options_.share || (early(item) && options_.share->runs())) return {};
    if (early(item)) return std::vector<uint8_t>(blocks_of(capture_of(item)).size());
    return mine_[item.id];
  }

  // Captures of which nothing is run here are not even primed for, unless their results are made here.
  std::vector<Item> of_share(const std::vector<Item>& items) const {
    std::vector<Item> some = items;
    if (options_.share && options_.share->runs())
      std::erase_if(some, [&](const Item& item) { return !std::ranges::count(mine_[item.id], 1); });
    return some;
  }

  bool has_results(const Item& item) const { return !options_.share || !options_.share->runs() || early(item); }

  // Tells the store what it has to hold of each capture, and how far it has that.
  void begin_store(const std::vector<Item>& items) {
    std::vector<CaptureShape> shapes(items.size());
    TruthSlots slots(*tracer_);
    for (const Item& item : items) {
      shapes[item.id] = shape_of(sensor_of(item), capture_of(item), goals_of(item), slots);
      if (!has_results(item)) shapes[item.id].mine = mine_of(item);
    }
    options_.store->begin(shapes);
    if (!cap_) cap_ = options_.store->cap();
    StoredWork work;
    for (const Item& item : items)
      add_stored(*options_.store, item.id, capture_of(item), goals_of(item), unknown_cap(item), work);
    report_.paths_kept = work.paths;
    if (options_.begun) options_.begun(work);
  }

  // Runs the first captures that are left, as many as may be in flight together, round by round of all of them, and
  // delivers them in their order. Returns those that are left then.
  std::span<const Item> run_batch(std::span<const Item> left) {
    const Stopwatch::time_point begun = Stopwatch::now();
    Batch batch;
    // What may be in flight depends on nothing that differs between the processes of a job.
    const size_t processes = together(left.front()) ? static_cast<size_t>(executor().processes()) : 1;
    size_t blocks = 0;
    double bytes = 0, paths = 0;
    const auto more = [&] {
      return blocks < kBlocksInFlight * processes && bytes < kBytesInFlight && primed_.size() < kPrimedInFlight;
    };
    while (batch.size() < left.size()) {
      const Item& item = left[batch.size()];
      paths += most_paths(item);
      // Where time is the budget, the first pilot tells what it is worth.
      if (!batch.empty() && (!more() || paths > kPathsInFlight * static_cast<double>(processes) || unknown_cap(item)))
        break;
      batch.push_back(take_up(item));
      bytes += batch.back()->bytes();
      blocks += blocks_of(batch.back()->work.capture).size();
    }
    try {
      while (run_rounds(batch)) {
      }
    } catch (...) {
      save_all(batch);
      throw;
    }
    share_seconds(batch, seconds_since(begun));
    std::optional<FinishFirst> all;
    if (!options_.store) all.emplace();  // what a state has can be delivered later
    for (auto& c : batch)
      if (!report_.stopped && c->planner && c->planner->whole() && has_results(c->item))
        stop_point(), deliver(*c), c.reset();
      else
        leave(*c);
    if (primed_.size() > 1) primed_.erase(primed_.begin(), primed_.end() - 1);
    return left.subspan(batch.size());
  }

  double most_paths(const Item& item) const {
    return static_cast<double>(capture_of(item).problems()) * goals_of(item).all.max_paths;
  }

  // One round of every capture that is not finished, all of them at once. False when there is nothing more to run.
  bool run_rounds(const Batch& batch) {
    std::vector<Round> rounds;
    std::vector<CapturePlanner*> of;
    std::vector<SentRound> sent;
    const bool shared = together(batch.front()->item);
    for (uint32_t c = 0; c < batch.size(); ++c) {
      if (!batch[c]->planner) continue;
      std::optional<Round> round = batch[c]->planner->next();
      if (!round) continue;
      if (shared) sent.push_back(sent_round(c, *round));
      rounds.push_back(std::move(*round)), of.push_back(&*batch[c]->planner);
    }
    if (shared) exchange(executor(), sent, cap_);
    if (follows(batch.front()->item)) rounds = rounds_of(sent, batch);
    if (rounds.empty()) return false;
    const bool here = executor().processes() > 1 && !shared;
    report_.stopped = !(here ? local_ : executor()).run(rounds, options_.stop, progress_.get());
    for (size_t i = 0; i < of.size(); ++i) of[i]->ran(rounds[i]);
    if (report_.stopped) save_all(batch);
    return !report_.stopped;
  }

  std::shared_ptr<const Primed> prime(const Item& item, CaptureLog& log) {
    const Sensor& sensor = sensor_of(item);
    const Capture& capture = capture_of(item);
    log.new_tracer = tracer_of(capture);
    const size_t bakes = kits_->optics_bakes();
    Kit kit = kits_->get(item.state.spectral, sensor, capture, tracer_);
    log.new_optics = kits_->optics_bakes() > bakes;
    check_capture(sensor, capture, kit);
    if (options_.diagnose)
      for (const Diagnostic& d : diagnose_light_paths(*tracer_, sources_, *kit.optics, options_.pipeline,
                                                      goals_of(item).all.max_paths, sensor, *kit.environment))
        if (diagnosed_.insert(d.text).second) options_.diagnose(d);
    for (const auto& p : primed_)
      if (p->made_of(*tracer_, kit)) return p;
    primed_.push_back(
        std::make_shared<const Primed>(tracer_, std::move(kit), sensor, capture.state, options_.pipeline));
    return primed_.back();
  }

  std::unique_ptr<InFlight> take_up(const Item& item) {
    Sensor& sensor = sensor_of(item);
    const Capture& capture = capture_of(item);
    CaptureLog log;
    std::shared_ptr<const Primed> primed = prime(item, log);
    auto c = std::make_unique<InFlight>(item, primed, sensor, capture, goals_of(item),
                                        judged_bands(sensor, capture, budget_of(item), *primed->kit.bands));
    c->work.mine = mine_of(item), c->work.bias = bias_of(options_.biases, sensor.name(), capture.state);
    c->log = std::move(log);
    if (unknown_cap(item)) {
      c->work.after_pilot = [this](CaptureWork& w, std::span<const double> needs, double paths, double seconds) {
        fix_cap(w, needs, paths, seconds);
      };
      shorten_pilots(c->work.goals);
    }
    if (!follows(item)) c->plan(saving_);
    sensor.begin(capture);
    return c;
  }

  // Counts a capture that has no result here.
  void leave(InFlight& c) {
    if (c.planner) report_.statistics.merge(c.planner->statistics());
    if (report_.stopped) return;
    kits_->done(c.item.state.spectral);
    if (!c.planner) return;
    report_.captures_waiting += !c.planner->whole();
    report_.pilots_waiting += c.planner->waits_for_pilot();
    report_.paths_waiting += c.planner->waits_for();
  }

  void deliver(InFlight& c) {
    const Item& item = c.item;
    const Sensor& sensor = c.work.sensor;
    const Capture& capture = c.work.capture;
    CaptureLog& log = c.log;
    log.statistics = c.planner->statistics();
    CaptureResult result = with_blind_flagged(sensor, capture, c.result->finish());
    report_.shortfalls[item.sensor].shortfall.merge(c.result->shortfall());
    add_points(*c.primed, sensor_of(item), capture, result);
    result.task = item.task, result.capture = item.capture;
    judge_.add(item.sensor, c.work, c.primed->kit.bands->reference, result, report_, log);
    outcomes_[item.sensor].add(sensor.bands(capture.state), result, log.statistics);
    if (item.task == 0 && item.capture == 0)
      outcomes_[item.sensor].looks_down = middle_ray(sensor, capture, capture.problems() / 2).ray.direction.z < 0;
    log.sensor = sensor.name();
    log.task = sensor.tasks()[item.task].name;
    log.capture = capture.name;
    log.state = c.primed->state().text();
    log.kernel = c.primed->pipeline.kernel();
    log.id = item.id;
    log.window = capture.window, log.problems = capture.problems();
    report_.statistics.merge(log.statistics);
    ++report_.captures;
    report_.problems += capture.problems();
    report_.log.push_back(std::move(log));
    const Stopwatch::time_point handed = Stopwatch::now();
    kits_->done(item.state.spectral);
    sensor_of(item).accept(std::move(result));
    report_.deliver_seconds += seconds_since(handed);
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
    if (options_.time_worth) options_.time_worth(cap_);
  }

  void finish() {
    report_.share_in_embree = report_.statistics.cycles ? static_cast<double>(report_.statistics.trace.cycles) /
                                                              static_cast<double>(report_.statistics.cycles)
                                                        : 0;
    report_.seconds = seconds_since(start_);
    judge_.finish(options_, cap_, report_);
  }

  std::shared_ptr<const Scene> scene_;
  const SourceSpecs& sources_;
  std::span<const std::unique_ptr<Sensor>> sensors_;
  const JobOptions& options_;
  Stopwatch::time_point start_ = Stopwatch::now();
  JobReport report_;
  std::unique_ptr<TracerCache> tracers_;
  std::shared_ptr<const Tracer> tracer_;  // of the capture that runs
  std::unique_ptr<Progress> progress_;
  std::unique_ptr<Kits> kits_;
  std::vector<std::shared_ptr<const Primed>> primed_;  // of the captures in flight, and the one before
  LocalExecutor local_;
  Saving saving_;
  std::vector<SensorOutcome> outcomes_;  // of each sensor
  std::set<std::string> useless_;        // sensors
  Judge judge_;
  std::set<std::string> diagnosed_;         // by text
  std::vector<std::vector<uint8_t>> mine_;  // [capture][block] of the sensors that the share runs
  double total_problems_ = 0;
  uint32_t cap_ = 0;
};

}  // namespace

JobReport run_job(const std::shared_ptr<const Scene>& scene, const SourceSpecs& sources,
                  std::span<const std::unique_ptr<Sensor>> sensors, const JobOptions& options) {
  return Job(scene, sources, sensors, options).run();
}

}  // namespace suite
