// When what moves, comes or goes does so, and how large it is: for those who look at a whole window before rays do.
#include <algorithm>
#include <cmath>

#include "motion/track.h"
#include "scene/primitives.h"
#include "trace/embree_internal.h"

namespace suite {

namespace {

// Rows of a timetable that begin within a window.
void add_rows(const Timetable& when, TimeSpan window, std::vector<double>& times) {
  const double length = window.end - window.begin;
  if (when.times.empty()) return;
  if (!(when.period > 0)) {
    times.insert(times.end(), when.times.begin(), when.times.end());
    return;
  }
  if (length / when.period * static_cast<double>(when.times.size()) > Tracer::kMostChanges) return;
  for (const double row : when.times)
    for (double t = row + std::ceil((window.begin - row) / when.period) * when.period; t <= window.end;
         t += when.period)
      times.push_back(t);
}

}  // namespace

std::vector<double> Tracer::changes(uint32_t number) const {
  std::vector<double> times;
  if (!moving_) return times;
  const TimeSpan window = moving_->window;
  const Scene& scene = *world_->scene;
  for (uint32_t n = object(number).node; n != kNone; n = world_->flat.nodes[n].parent) {
    const MovingNode& node = world_->flat.nodes[n];
    if (node.track != kNone) {
      const Track& track = *scene.tracks[node.track].track;
      const TimeSpan covered = track.covered();
      times.insert(times.end(), {covered.begin, covered.end});
      const TimeSpan both{std::max(covered.begin, window.begin), std::min(covered.end, window.end)};
      if (both.begin <= both.end) std::ranges::copy(track.kinks(both), std::back_inserter(times));
    }
    if (node.schedule == kNone) continue;
    const Schedule& schedule = scene.schedules[node.schedule];
    times.insert(times.end(), {schedule.life.begin, schedule.life.end});
    add_rows(schedule.when, window, times);
  }
  std::erase_if(times, [&](double t) { return !(t > window.begin && t < window.end); });
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

bool Tracer::there(uint32_t number, double time) const {
  const uint32_t node = object(number).node;
  if (node == kNone || !moving_) return true;
  return world_->there(node, std::clamp(time, moving_->window.begin, moving_->window.end));
}

std::string Tracer::motion_name(uint32_t number) const {
  const Scene& scene = *world_->scene;
  for (uint32_t n = object(number).node; n != kNone; n = world_->flat.nodes[n].parent) {
    const MovingNode& node = world_->flat.nodes[n];
    if (node.track != kNone && !scene.tracks[node.track].name.empty()) return scene.tracks[node.track].name;
    if (node.schedule != kNone && !scene.schedules[node.schedule].name.empty())
      return scene.schedules[node.schedule].name;
  }
  return "what moves";
}

Box3 Tracer::local_box(uint32_t number) const {
  const TracedObject o = object(number);
  return o.primitive != kNone ? primitive_box(world_->scene->primitives[o.primitive]) : world_->meshes[o.mesh].box;
}

}  // namespace suite
