#include "lidar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/diagnostics.h"
#include "base/files.h"
#include "base/inputs.h"
#include "base/interrupt.h"
#include "base/number_text.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "base/run_app.h"
#include "base/stopwatch.h"
#include "continued.h"
#include "detect_job.h"
#include "formats/response/response_file.h"
#include "guard.h"
#include "lidar/pulse_train.h"
#include "lidar/trace.h"
#include "log.h"
#include "scheduler/moments.h"
#include "spectral/planck.h"

namespace suite {

struct LidarJobs::Job {
  const SimulationLidar& of;
  const ClockedTrain& train;
  std::optional<DetectionSpec> detection;  // nothing: responses are stored only
  uint64_t pulses = 0;                     // at which a beam leaves
  ResponseHead head;
  std::unique_ptr<DetectJob> detect;
  std::optional<PulseReport> report;
  double seconds = 0;
  // The error at the laser radar's place in the text, unless it has one.
  Error located(const Error& e) const {
    if (!e.where().file.empty()) return e;
    return Error(of.where, "laser radar '" + of.instrument.name + "': " + e.message(), e.hint(), e.code());
  }
};

namespace {

void check_lidar_usage(const Cli& cli, const Simulation& sim) {
  // Nothing of a run is cut or continued; and what is of images says nothing where there are none.
  for (const char* option :
       {"--time", "--state", "--more", "--part", "--merge", "--plan", "--study", "--ranks", "--link"})
    if (cli.given(option))
      throw UsageError(std::string(option) +
                       " does not go with laser radars: take them out of the text, or leave it out");
  if (!sim.sensors.empty()) {
    if (cli.given("--resume"))
      throw UsageError(
          "--resume goes on with laser radars where they are alone: take the other sensors out of the text");
    return;
  }
  if (sim.heat) throw UsageError("the simulation has `heat`, which images need, and laser radars only");
  for (const char* option :
       {"--target-error", "--target-floor", "--target-bands", "--stop", "--method", "--cache-memory", "--memory",
        "--heat", "--heat-operator", "--heat-only", "--view", "--view-size", "--air"})
    if (cli.given(option))
      throw UsageError(std::string(option) + " is of images, and the simulation has laser radars only");
}

// --paths N
void set_paths(const RenderOptions& o, Simulation& sim) {
  if (o.paths.empty()) return;
  const auto n = number_of(o.paths);
  if (!n || *n != std::floor(*n) || *n < 2 || *n > (1 << 30))
    throw UsageError("--paths of laser radars is one number from 2 to 2^30, found '" + o.paths + "'");
  for (SimulationLidar& l : sim.lidars) l.instrument.paths = static_cast<uint32_t>(*n);
}

std::optional<DetectionSpec> detection_of(const Params& text, bool heads) {
  const Params laser = text.at("laser");
  if (!text.has("detectors")) {
    for (const char* key : {"pulses_in_air", "output", "las", "csv"})
      if (text.has(key))
        throw Error(text.where(key), "'" + std::string(key) + "' belongs to detectors, and there are none",
                    "detectors: [{kind: waveform, ...}]");
    if (laser.has("pulse")) read_pulse(laser, pulse_of_file);
    return std::nullopt;
  }
  DetectionSpec spec = read_detection(text, laser, pulse_of_file);
  // Channels have receivers of their own: each knows its pulse.
  if (heads) spec.in_air = PulsesInAir::unfold;
  return spec;
}

// Responses go into their file, and on to detection.
class Tee : public ResponseSink {
 public:
  Tee(ResponseWriter& writer, DetectJob* detect) : writer_(writer), detect_(detect) {}
  void take(ResponseBlock&& block) override {
    if (detect_) detect_->take(ResponseBlock(block));
    writer_.take(std::move(block));
  }

 private:
  ResponseWriter& writer_;
  DetectJob* detect_;
};

std::string response_file(const RenderOptions& o, const LidarInstrument& i) {
  return in_folder(o.output, i.name + "_response.h5");
}

// At most: every path of a row in a bin of its own.
double response_bytes(const ResponseHead& head, const LidarInstrument& i, uint64_t pulses) {
  const double rows = static_cast<double>(pulses) * static_cast<double>(head.pixel_count());
  const double entries = std::min<double>(head.bins + 1.0, 2.0 * i.paths * i.orders + 1);
  return rows * (24 + entries * (8 + 16 * static_cast<double>(head.channels.size()))) +
         144.0 * static_cast<double>(pulses);
}

}  // namespace

LidarJobs::LidarJobs(const Cli& cli, const RenderOptions& options, Simulation& sim, bool several_ranks)
    : options_(options), simulation_(sim) {
  if (sim.lidars.empty()) return;
  check_lidar_usage(cli, sim);
  if (several_ranks) throw UsageError("laser radars run in one process: start it without mpirun");
  if (sim.periodic) throw Error(sim.periodic_where, kNoPeriodicLidar, kNoPeriodicLidarHint);
  set_paths(options, sim);
  for (const SimulationLidar& l : sim.lidars) {
    const auto& train = dynamic_cast<const ClockedTrain&>(*l.instrument.pulses);
    auto job = std::make_unique<Job>(Job{l, train, {}, 0, {}, nullptr, {}, 0});
    job->detection = detection_of(*l.instrument.detection, train.spec().deflector->channels() > 1);
    job->pulses = train.lit();
    if (job->pulses == 0)
      throw Error(l.where, "no pulse of laser radar '" + l.instrument.name + "' leaves its scanner", "longer tasks");
    jobs_.push_back(std::move(job));
  }
}

LidarJobs::~LidarJobs() = default;

void LidarJobs::check(const std::shared_ptr<const Scene>& scene) {
  std::vector<std::string> names = scene->tags;
  for (const Material& m : scene->materials) names.push_back(m.id);
  for (const auto& job : jobs_) {
    const LidarInstrument& i = job->of.instrument;
    for (const std::string& tag : i.tags)
      if (std::ranges::find(names, tag) == names.end())
        throw Error(job->of.where, "laser radar '" + i.name + "': the scene has no tag and no material '" + tag + "'",
                    name_hint(tag, names));
    const TimeSpan span = job->train.span();
    check_motion(*scene, span.begin, span.end + i.gate.stop, job->of.where);
    job->head = response_head(*scene, i);
    if (job->detection)
      job->detect = std::make_unique<DetectJob>(
          *i.detection, std::move(*job->detection), job->head,
          DetectJob::Place{in_folder(options_.output, i.name), response_file(options_, i), job->pulses});
    if (job->detect) try {
        job->detect->rehearse(i.gate.start);
      } catch (const Error& e) {
        throw job->located(e);
      }
  }
  if (simulation_.unread) simulation_.unread->reject_unread();
}

void LidarJobs::forecast() const {
  for (const auto& job : jobs_) {
    const LidarInstrument& i = job->of.instrument;
    const auto rows = static_cast<double>(job->pulses) * static_cast<double>(job->head.pixel_count());
    std::printf(
        "laser radar '%s': %llu pulses (of %llu shots, the others leave no scanner), %zu pixels, %s paths of up to %u "
        "scatterings, %u range bins of %g ns from "
        "%.9g m on; responses take at most %s%s\n",
        i.name.c_str(), static_cast<unsigned long long>(job->pulses), static_cast<unsigned long long>(i.pulses->size()),
        job->head.pixel_count(), human_count(rows * i.paths).c_str(), i.orders, job->head.bins, i.gate.bin * 1e9,
        i.gate.start * kSpeedOfLight / 2, human_bytes(response_bytes(job->head, i, job->pulses)).c_str(),
        job->detect ? ", and are detected" : "");
  }
}

namespace {

std::string unfinished_file(const RenderOptions& o, const LidarInstrument& i) {
  return in_folder(o.output, i.name + "_response.unfinished.h5");
}

// Of a run of laser radars alone: all that its bytes depend on.
std::string identity_text(const StateIdentity& of, const Simulation& sim) {
  std::string all;
  for (const auto& [what, hash] : of) all += what + "=" + hash + "\n";
  for (const SimulationLidar& l : sim.lidars) all += strf("paths=%u\n", l.instrument.paths);
  return sha256(all);
}

// What an interrupted run left goes through again; the shot behind it.
uint64_t take_up(const std::string& path, const std::string& identity, const PulseTrain& train, ResponseSink& sink) {
  const ResponseReader left(path);
  if (left.unfinished() != identity)
    throw Error(Where{path, 0, 0, {}, -1}, "is of another run: another text, scene, seed, number of paths or program",
                "the command that was interrupted with --resume, or another folder with -o");
  for (size_t b = 0; b < left.blocks(); ++b) sink.take(left.block(b));
  uint64_t shot = 0;
  for (uint64_t lit = 0; lit < left.pulses(); ++shot) lit += train.pulse(shot).has_value();
  return shot;
}

}  // namespace

bool LidarJobs::finished(const Job& job) const {
  return options_.resume && file_exists(response_file(options_, job.of.instrument)) &&
         !file_exists(unfinished_file(options_, job.of.instrument));
}

bool LidarJobs::run(Job& job, const std::shared_ptr<const Scene>& scene, const std::string& identity) {
  const LidarInstrument& i = job.of.instrument;
  const Stopwatch::time_point begun = Stopwatch::now();
  if (job.detect) make_folder(in_folder(options_.output, i.name));
  const TimeSpan span = job.train.span();
  SourcesInTime sources(simulation_.sources, *scene);
  ResponseWriter writer(response_file(options_, i), job.head, command_line());
  Tee tee(writer, job.detect.get());
  const std::string unfinished = unfinished_file(options_, i);
  TraceOptions options;
  if (options_.resume && file_exists(unfinished)) options.first = take_up(unfinished, identity, *i.pulses, tee);
  Progress progress("laser radar '" + i.name + "'", static_cast<double>(job.pulses), "pulse");
  options.seed = simulation_.pipeline.seed, options.method = simulation_.pipeline, options.progress = &progress;
  try {
    job.report = trace_pulses(scene, sources.at(0.5 * (span.begin + span.end)), i, options, tee);
    if (job.detect) job.detect->end_pulses();
  } catch (const Stopped&) {
    const FinishFirst whole;
    if (!identity.empty()) writer.leave(unfinished, identity);
    note("laser radar '" + i.name + "': stopped" +
         (identity.empty() ? ", none of its responses is kept" : "; --resume continues from " + unfinished));
    return false;
  } catch (const Error& e) {
    throw job.located(e);
  }
  progress.finish();
  const FinishFirst whole;
  writer.finish();
  if (job.detect) job.detect->finish();
  std::filesystem::remove(unfinished);
  job.seconds = seconds_since(begun);
  const PulseReport& r = *job.report;
  note(strf("laser radar '%s': %s pulses, %s paths, %.6g photons within the gate, %.3g outside; paths begin at the %s",
            i.name.c_str(), human_count(static_cast<double>(r.pulses)).c_str(),
            human_count(static_cast<double>(r.paths)).c_str(), r.photons, r.outside,
            r.laser_first ? "laser" : "receiver"));
  if (r.smooth)
    note("laser radar '" + i.name +
         "': light that meets smooth surfaces alone (corner cubes, mirrors, still water straight down) is left out");
  return true;
}

bool LidarJobs::run(const std::shared_ptr<const Scene>& scene, const std::string& identity) {
  const StopInGoodOrder signals;
  if (options_.resume && !jobs_.empty() && std::ranges::none_of(jobs_, [&](const auto& job) {
        return finished(*job) || file_exists(unfinished_file(options_, job->of.instrument));
      }))
    throw UsageError("there is nothing to continue from in " + options_.output + ": run without --resume");
  for (const auto& job : jobs_) {
    if (finished(*job)) {
      note("laser radar '" + job->of.instrument.name + "' was finished before");
      continue;
    }
    if (!run(*job, scene, identity)) return false;
  }
  return true;
}

int end_by_signal(const std::string& left) {
  emit({Dr::stopped, "stopped: " + left});
  return 128 + stop_signal();
}

int LidarJobs::run_alone(const std::shared_ptr<const Scene>& scene, const JobOptions& options) {
  if (options_.dry_run) {
    check_place(options_, simulation_, false);
    forecast();
    return 0;
  }
  const RunLock lock = lock_place(options_, simulation_);
  const bool whole = run(scene, identity_text(identity_of(simulation_, options), simulation_));
  write_log(in_folder(options_.output, "render.json"), {}, options, log());
  return whole ? 0 : end_by_signal("laser radars that were finished are in " + options_.output);
}

Json LidarJobs::log() const {
  Json all = Json::array();
  for (const auto& job : jobs_) {
    if (!job->report) continue;
    const PulseReport& r = *job->report;
    Json j = Json::object();
    j.set("sensor", job->of.instrument.name);
    j.set("response", job->of.instrument.name + "_response.h5");
    j.set("pulses", r.pulses), j.set("shots_without_a_beam", r.dark);
    j.set("rows", r.rows), j.set("paths", r.paths), j.set("rejected_contributions", r.failures);
    j.set("photons", r.photons), j.set("photons_outside_of_the_gate", r.outside), j.set("truncated", r.truncated);
    j.set("polarisation_not_known", r.unknown_polarisation);
    j.set("paths_begin_at", r.laser_first ? "laser" : "receiver"), j.set("passive_light", r.passive),
        j.set("leaves_passed_once", r.hot_spot), j.set("smooth_surfaces_alone_left_out", r.smooth);
    j.set("range_bins", uint64_t{job->head.bins}), j.set("bin_ns", job->head.bin * 1e9);
    j.set("group_index", job->head.group_index), j.set("detected", job->detect != nullptr);
    j.set("seconds", job->seconds);
    all.push(std::move(j));
  }
  return all;
}

std::vector<std::array<double, 2>> lidar_windows_um(const Simulation& sim) {
  std::vector<std::array<double, 2>> windows;
  for (const SimulationLidar& l : sim.lidars) {
    const double half = 0.5 * std::max(l.instrument.receiver.filter_um, l.instrument.laser.width_um);
    windows.push_back({l.instrument.laser.wavelength_um - half, l.instrument.laser.wavelength_um + half});
  }
  return windows;
}

}  // namespace suite
