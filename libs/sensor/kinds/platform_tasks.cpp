// Tasks of a platform and the captures that clocks, triggers and read-outs make of them.
#include <algorithm>
#include <cmath>

#include "sensor/kinds/platform.h"

namespace suite {

namespace {

constexpr size_t kMostCaptures = 10000000;

// Times at which the vehicle has gone another `distance` metres, from the start of a task on.
std::vector<double> distance_triggers(const Track& track, TimeWindow w, double distance) {
  std::vector<double> times{w.begin};
  constexpr int steps = 20000;
  double gone = 0, next = distance;
  Vec3 before = track.at(w.begin).translation;
  for (int i = 1; i <= steps && w.end > w.begin; ++i) {
    const double t = w.begin + (w.end - w.begin) * i / steps;
    const Vec3 here = track.at(t).translation;
    const double moved = length(here - before);
    for (; moved > 0 && gone + moved >= next && times.size() < kMostCaptures; next += distance)
      times.push_back(t - (w.end - w.begin) / steps * (gone + moved - next) / moved);
    gone += moved;
    before = here;
  }
  return times;
}

std::vector<double> frame_times(const PlatformSpec& spec, const Instrument& i, TimeWindow w, const Params& where) {
  if (i.trigger_distance > 0) return distance_triggers(*spec.track, w, i.trigger_distance);
  if (!i.triggers.empty()) {
    std::vector<double> times;
    for (const double t : i.triggers)
      if (t >= w.begin && t <= w.end) times.push_back(t);
    return times;
  }
  if (!(i.clock_rate > 0)) return {w.begin + i.clock_offset};
  const double count = std::floor((w.end - w.begin - i.clock_offset) * i.clock_rate + 1e-6) + 1;
  if (!(count < kMostCaptures))
    throw where.error(strf("%.0f frames in one task", count), "lower rate_hz or shorten the task");
  std::vector<double> times;
  for (double k = 0; k < count; ++k) times.push_back(w.begin + i.clock_offset + k / i.clock_rate);
  return times;
}

// One event: a capture for each segment of the array.
void add_event(PlatformSpec& spec, Task& task, std::vector<PlatformSpec::Part>& parts, size_t array_number,
               TimeWindow window, uint32_t rows, uint64_t event) {
  const FocalArray& array = spec.arrays[array_number];
  for (const size_t s : array.segments) {
    Capture c;
    c.name = strf("%s_%04llu", array.image.c_str(), static_cast<unsigned long long>(event));
    if (array.segments.size() > 1) c.name += strf("_%zu", s - array.segments[0]);
    c.window = window;
    c.columns = spec.segments[s].columns;
    c.rows = rows;
    c.state = s;
    c.convergence = spec.segments[s].convergence;
    c.band_targets = spec.segments[s].band_targets;
    c.detector_noise = spec.segments[s].detector_noise;
    for (size_t chip = 0; chip < spec.segments[s].chips; ++chip)
      c.own_convergence = c.own_convergence || array.chips[spec.segments[s].first_chip + chip].convergence.has_value();
    if (array.time_bins > 1) c.bin_by = Capture::BinBy::time, c.bins = array.time_bins;
    task.captures.push_back(std::move(c));
    parts.push_back({array_number, s, event});
  }
}

void add_lines(PlatformSpec& spec, Task& task, std::vector<PlatformSpec::Part>& parts, size_t array_number,
               const Params& where, uint64_t& event) {
  const FocalArray& array = spec.arrays[array_number];
  const Readout& r = array.readout;
  const double lines = std::max(1.0, std::floor((task.window.end - task.window.begin) / r.line_period + 1e-6));
  const uint32_t rows_a_line = r.kind == Readout::Kind::whisk ? array.rows : 1;
  if (!(lines * rows_a_line < 4e9) || lines / r.per_capture > kMostCaptures)
    throw where.error(strf("%.0f lines in one task", lines), "lower the rate or shorten the task");
  const uint64_t count = static_cast<uint64_t>(lines);
  for (uint64_t first = 0; first < count; first += r.per_capture, ++event) {
    const uint32_t n = static_cast<uint32_t>(std::min<uint64_t>(r.per_capture, count - first));
    const double begin = task.window.begin + static_cast<double>(first) * r.line_period;
    const double last =
        (n - 1) * r.line_period + (r.samples ? (r.samples - 1) * r.sample_period : 0) + (r.stages - 1) * r.line_period;
    add_event(spec, task, parts, array_number, {begin, begin + last + r.integration}, n * rows_a_line, event);
  }
}

// The motion must be known all through the window, and be one.
void check_motion(const PlatformSpec& spec, const Instrument& instrument, TimeWindow w, const Params& task) {
  auto check = [&](TimeSpan s, const char* what) {
    if (w.begin < s.begin || w.end > s.end)
      throw task.error(
          strf("the task needs %s from %g to %g s, and knows it from %g to %g s", what, w.begin, w.end, s.begin, s.end),
          "shorten the task or extend the motion");
  };
  check(spec.track->covered(), "the vehicle's motion");
  for (const Attachment& a : instrument.chain)
    if (a.mount) check(a.mount->covered(), "a mount's motion");
  for (int i = 0; i <= 16; ++i) {
    const double t = w.begin + (w.end - w.begin) * i / 16;
    Pose pose;
    try {
      pose = pose_at(spec, instrument, t);
    } catch (const Error& e) {
      throw task.error(strf("no pose at %g s: %s", t, e.message().c_str()), e.hint());
    }
    if (!finite(pose.translation) || !finite(pose.vector({0, 0, 1})))
      throw task.error(strf("the instrument '%s' has no pose at %g s", instrument.name.c_str(), t),
                       "is a mount's target in its own place?");
  }
}

}  // namespace

void plan_captures(PlatformSpec& spec, const Params& params, const SensorContext& context) {
  const Params list = params.at("tasks");
  std::vector<uint64_t> event(spec.arrays.size(), 0);
  for (const Params& p : list.items()) {
    Task task;
    task.name = p.name("name", strf("task_%zu", spec.tasks.size() + 1));
    for (const Task& other : spec.tasks)
      if (other.name == task.name) throw p.error("two tasks are named '" + task.name + "'", "give each its own name");
    task.window.begin = context.time(p.at("start"));
    const auto stop = p.find("stop");
    task.window.end = stop ? context.time(*stop) : task.window.begin;
    if (task.window.end < task.window.begin) throw stop->error("the task stops before it starts");
    std::vector<PlatformSpec::Part> parts;
    for (size_t a = 0; a < spec.arrays.size(); ++a) {
      const FocalArray& array = spec.arrays[a];
      const Instrument& instrument = spec.instruments[array.instrument];
      const Readout& r = array.readout;
      if (array.scans()) {
        add_lines(spec, task, parts, a, p, event[a]);
        continue;
      }
      for (const double t : frame_times(spec, instrument, task.window, p))
        add_event(spec, task, parts, a, {t, t + (array.rows - 1) * r.row_time + r.integration}, array.rows, event[a]++);
    }
    TimeWindow needed = task.window;
    for (const Capture& c : task.captures) needed.end = std::max(needed.end, c.window.end);
    for (const Instrument& i : spec.instruments) check_motion(spec, i, needed, p);
    spec.tasks.push_back(std::move(task));
    spec.parts.push_back(std::move(parts));
  }
  if (spec.tasks.empty()) throw list.error("a platform has at least one task", "tasks: [{start: 0, stop: 1}]");
  for (size_t a = 0; a < spec.arrays.size(); ++a)
    if (event[a] == 0)
      throw list.error(
          "the instrument '" + spec.instruments[spec.arrays[a].instrument].name + "' takes nothing in any of the tasks",
          "its clock's offset or its triggers lie outside them");
  turn_strips(spec);
}

}  // namespace suite
