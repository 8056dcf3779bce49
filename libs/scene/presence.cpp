#include "scene/presence.h"

#include <algorithm>

#include "motion/track.h"

namespace suite {

namespace {

// What a row of a schedule makes of the placement; before the first row it is as without.
std::optional<uint32_t> made_by(const Schedule& s, std::optional<size_t> row) {
  if (!row) return kNone;
  return s.there[*row] ? std::optional(s.material[*row]) : std::nullopt;
}

bool ends(const Scene& scene, uint32_t track) { return track != kNone && scene.tracks[track].track->absent_outside(); }

}  // namespace

std::optional<uint32_t> made_at(const Scene& scene, uint32_t track, uint32_t schedule, double t) {
  if (ends(scene, track) && !scene.tracks[track].track->covered().contains(t)) return std::nullopt;
  if (schedule == kNone) return kNone;
  const Schedule& s = scene.schedules[schedule];
  if (!(t >= s.life.begin && t < s.life.end)) return std::nullopt;
  return made_by(s, s.when.at(t));
}

std::vector<uint32_t> made_of(const Scene& scene, uint32_t schedule) {
  if (schedule == kNone) return {kNone};
  const Schedule& s = scene.schedules[schedule];
  std::vector<uint32_t> all;
  const auto add = [&](std::optional<uint32_t> made) {
    if (made && std::find(all.begin(), all.end(), *made) == all.end()) all.push_back(*made);
  };
  if (!(s.when.period > 0)) add(kNone);
  for (size_t row = 0; row < s.when.times.size(); ++row) add(made_by(s, row));
  return all;
}

Presence presence(const Scene& scene, uint32_t track, uint32_t schedule, std::optional<uint32_t> material,
                  TimeSpan span) {
  Presence p{true, true, span};
  if (ends(scene, track)) {
    const TimeSpan c = scene.tracks[track].track->covered();
    p.all = c.begin <= span.begin && span.end <= c.end;
    p.hull = {std::max(span.begin, c.begin), std::min(span.end, c.end)};
    if (!(p.hull.begin <= p.hull.end)) return {};
  }
  if (schedule == kNone) return material.value_or(kNone) == kNone ? p : Presence{};
  const Schedule& s = scene.schedules[schedule];
  p.all = p.all && s.life.begin <= span.begin && span.end < s.life.end;
  const TimeSpan life{std::max(p.hull.begin, s.life.begin), std::min(p.hull.end, s.life.end)};
  if (!(life.begin <= life.end && life.begin < s.life.end)) return {};
  p.any = false;
  s.when.over(life, [&](std::optional<size_t> row, TimeSpan held) {
    const std::optional<uint32_t> made = made_by(s, row);
    if (!made || (material && *made != *material)) {
      p.all = false;
      return;
    }
    p.hull = p.any ? TimeSpan{std::min(p.hull.begin, held.begin), std::max(p.hull.end, held.end)} : held;
    p.any = true;
  });
  return p.any ? p : Presence{};
}

}  // namespace suite
