// What can be asked about the moving parts of a scene before anything is traced.
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/track.h"
#include "scene/scene.h"

namespace suite {

void check_motion(const Scene& scene, double begin, double end, const Where& where) {
  std::vector<bool> used(scene.tracks.size(), false);
  for (const Group& g : scene.groups)
    for (const Placement& p : g.placements)
      if (p.track != kNone) used[p.track] = true;
  for (const Volume& v : scene.volumes)
    if (v.track != kNone) used[v.track] = true;
  for (size_t k = 0; k < scene.tracks.size(); ++k) {
    if (!used[k]) continue;
    const TimeSpan c = scene.tracks[k].track->covered();
    if (!c.contains(begin) || !c.contains(end))
      throw Error(where,
                  strf("the motion of %s is known from %.9g to %.9g s, it is needed ", scene.tracks[k].name.c_str(),
                       c.begin, c.end) +
                      (begin == end ? strf("at %.9g s", begin) : strf("from %.9g to %.9g s", begin, end)),
                  "give it more keys, or look at another time");
  }
}

double time_of_all(const Scene& scene) {
  double latest = -std::numeric_limits<double>::infinity();
  bool zero = true;
  for (const SceneTrack& t : scene.tracks) {
    const TimeSpan c = t.track->covered();
    latest = std::max(latest, c.begin);
    zero = zero && c.contains(0);
  }
  return zero ? 0 : std::isfinite(latest) ? latest : 0;
}

}  // namespace suite
