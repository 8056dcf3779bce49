// What can be asked about the moving parts of a scene before anything is traced.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "motion/track.h"
#include "scene/presence.h"

namespace suite {

bool changes_in_time(const Scene& scene) { return !scene.tracks.empty() || !scene.schedules.empty(); }

namespace {

// When each track is needed in a span: while what moves along it is there.
std::vector<std::optional<TimeSpan>> needed(const Scene& scene, TimeSpan span) {
  std::vector<std::optional<TimeSpan>> all(scene.tracks.size());
  const auto need = [&](uint32_t track, TimeSpan s) {
    std::optional<TimeSpan>& n = all[track];
    n = n ? TimeSpan{std::min(n->begin, s.begin), std::max(n->end, s.end)} : s;
  };
  for (const Group& g : scene.groups)
    for (const Placement& p : g.placements)
      if (p.track != kNone)
        if (const Presence there = presence(scene, p.track, p.schedule, {}, span); there.any) need(p.track, there.hull);
  for (const Volume& v : scene.volumes)
    if (v.track != kNone) need(v.track, span);
  return all;
}

}  // namespace

void check_motion(const Scene& scene, double begin, double end, const Where& where) {
  const auto needs = needed(scene, {begin, end});
  for (size_t k = 0; k < scene.tracks.size(); ++k) {
    if (!needs[k]) continue;
    const TimeSpan c = scene.tracks[k].track->covered(), n = *needs[k];
    if (!c.contains(n.begin) || !c.contains(n.end))
      throw Error(where,
                  strf("the motion of %s is known from %.9g to %.9g s, it is needed ", scene.tracks[k].name.c_str(),
                       c.begin, c.end) +
                      (n.begin == n.end ? strf("at %.9g s", n.begin) : strf("from %.9g to %.9g s", n.begin, n.end)),
                  "give it more keys, look at another time, or let it be absent then ('outside: absent')");
  }
}

double time_of_all(const Scene& scene) {
  double latest = -std::numeric_limits<double>::infinity();
  bool zero = true;
  for (const SceneTrack& t : scene.tracks) {
    if (t.track->absent_outside()) continue;
    const TimeSpan c = t.track->covered();
    latest = std::max(latest, c.begin);
    zero = zero && c.contains(0);
  }
  return zero ? 0 : std::isfinite(latest) ? latest : 0;
}

}  // namespace suite
