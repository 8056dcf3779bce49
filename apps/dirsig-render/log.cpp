#include "log.h"

#include <sys/resource.h>

#include <algorithm>

#include "base/diagnostics.h"
#include "base/files.h"
#include "base/json.h"
#include "base/parallel.h"
#include "scheduler/executor.h"
#include "trace/tracer.h"

namespace suite {

double peak_bytes() {
  struct rusage use {};
  ::getrusage(RUSAGE_SELF, &use);
  return static_cast<double>(use.ru_maxrss) * 1024;
}

namespace {

Json json_of(const RunStatistics& s) {
  Json j = Json::object();
  j.set("paths", s.paths);
  j.set("nodes", s.nodes);
  j.set("rays", s.trace.rays);
  j.set("share_in_ray_tracer", s.cycles ? static_cast<double>(s.trace.cycles) / static_cast<double>(s.cycles) : 0.0);
  auto share = [&](uint64_t part) {
    return s.cycles ? static_cast<double>(part) / static_cast<double>(s.cycles) : 0.0;
  };
  j.set("share_in_sampling", share(s.path_cycles - std::min(s.path_cycles, s.trace.cycles)));
  j.set("share_in_shading", share(s.shade_cycles));
  j.set("share_in_sensor", share(s.sensor_cycles));
  j.set("rejected_samples", s.failures);
  j.set("truncated", s.paths ? s.truncated / static_cast<double>(s.paths) : 0.0);
  j.set("strayed", s.paths ? s.strayed / static_cast<double>(s.paths) : 0.0);
  return j;
}

// How many pixels of a sensor carry each bit.
Json json_of(const SensorQuality& q) {
  Json j = Json::object();
  j.set("sensor", q.sensor);
  j.set("pixels", q.counts.problems);
  j.set("flagged", q.counts.flagged);
  for (const QualityBit& b : quality_bits()) j.set(b.name, q.counts.with(b.bit));
  return j;
}

// What each sensor's results lack.
Json json_of(std::span<const JobReport::SensorShortfall> sensors) {
  Json all = Json::array();
  for (const auto& [name, lacks] : sensors) {
    Json j = Json::object();
    j.set("sensor", name);
    j.set("problems", lacks.problems);
    const auto part = [&](const char* key, const Shortfall::Part& of) {
      Json p = Json::object();
      p.set("problems", of.problems);
      p.set("mean_share", of.mean());
      p.set("largest_share", of.most);
      p.set("mean_share_of_all", lacks.mean_of_all(of));
      j.set(key, std::move(p));
    };
    part("unresolved", lacks.unresolved);
    part("truncated", lacks.truncated);
    j.set("rejecting_problems", lacks.rejecting);
    j.set("rejected_samples", lacks.rejected);
    all.push(std::move(j));
  }
  return all;
}

// Every diagnostic of the run, muted ones too.
Json diagnostics_json() {
  Json all = Json::array();
  for (const auto& [d, muted] : reported_diagnostics()) {
    const DiagnosticKind& kind = diagnostic_kind(d.code);
    Json j = Json::object();
    j.set("code", code_text(d.code));
    j.set("severity", to_text(kind.severity));
    j.set("text", printable(d.text));
    j.set("condition", kind.condition);
    j.set("cure", kind.cure);
    j.set("muted", muted);
    all.push(std::move(j));
  }
  return all;
}

}  // namespace

void write_log(const std::string& path, const JobReport& r, const JobOptions& options, Json lidars) {
  Json j = Json::object();
  j.set("command", command_line());
  j.set("version", kVersion);
  if (const std::string commit = build_commit(); !commit.empty()) j.set("commit", commit);
  j.set("ray_tracer", Tracer::engine());
  j.set("threads", threads());
  if (options.executor) j.set("ranks", options.executor->processes());
  j.set("seed", options.pipeline.seed);
  if (options.share && options.share->runs()) j.set("part", options.share->text());
  j.set("paths_kept", r.paths_kept);
  j.set("captures_waiting", r.captures_waiting);
  j.set("seconds", r.seconds);
  j.set("build_seconds", r.build_seconds);
  j.set("deliver_seconds", r.deliver_seconds);
  j.set("peak_bytes", peak_bytes());
  j.set("tracer_builds", r.tracer_builds);
  j.set("optics_bakes", r.optics_bakes);
  j.set("light_bakes", r.light_bakes);
  j.set("state_changes", r.state_changes);
  j.set("total", json_of(r.statistics));
  j.set("median_relative_error", r.median_relative_error);
  j.set("share_at_target", r.share_at_target);
  j.set("share_flagged", r.share_flagged);
  j.set("ended", r.stopped_by);
  j.set("diagnostics", diagnostics_json());
  Json quality = Json::array();
  for (const SensorQuality& q : r.quality) quality.push(json_of(q));
  j.set("quality", std::move(quality));
  j.set("lacks", json_of(r.shortfalls));
  Json captures = Json::array();
  for (const CaptureLog& c : r.log) {
    Json one = json_of(c.statistics);
    one.set("sensor", c.sensor);
    one.set("task", c.task);
    one.set("capture", c.capture);
    one.set("number", c.id);
    one.set("begin_s", c.window.begin);
    one.set("end_s", c.window.end);
    one.set("state", c.state);
    one.set("kernel", c.kernel);
    one.set("problems", c.problems);
    one.set("seconds", c.seconds);
    one.set("median_relative_error", c.median_relative_error);
    one.set("new_tracer", c.new_tracer);
    one.set("new_optics", c.new_optics);
    captures.push(std::move(one));
  }
  j.set("captures", std::move(captures));
  j.set("laser_radars", std::move(lidars));
  write_file(path, j.text());
}

}  // namespace suite
