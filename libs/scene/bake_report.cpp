// What a scene as a whole is told of its media.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "scene/baker.h"
#include "scene/endless_media.h"
#include "scene/shared_faces.h"

namespace suite {

void Baker::report_endless_media() {
  for (const EndlessMedium& e : endless_media(scene_, draft_.windows)) {
    const auto surface =
        std::find_if(draft_.geometry.begin(), draft_.geometry.end(), [&](auto& g) { return g.name == e.surface; });
    const std::string often =
        std::isinf(e.scatterings) ? "without ever being absorbed" : strf("about %.0f times", e.scatterings);
    const Where nowhere = e.surface.empty() ? draft_.ambient.where : Where{draft_.file, 0, 0, {}, -1};
    add("SP607", surface == draft_.geometry.end() ? nowhere : surface->where,
        "medium '" + e.medium +
            (e.surface.empty() ? std::string("' fills all space that no body fills")
                               : "' fills half of all space behind '" + e.surface + "'") +
            ": what does not come back scatters " + often + (e.at_um > 0 ? strf(" at %g um", e.at_um) : ""));
  }
}

void Baker::report_shared_faces(double time) {
  std::set<std::array<std::string, 2>> known;  // many copies are one fault
  for (const SharedFace& f : shared_faces(scene_, time)) {
    if (!known.insert({f.one, f.other}).second) continue;
    const auto one = std::ranges::find(draft_.geometry, f.one, &DraftGeometry::name);
    add("SP610", one == draft_.geometry.end() ? Where{draft_.file, 0, 0, {}, -1} : one->where,
        "'" + f.one + "' (medium '" + f.medium_one + "') and '" + f.other + "' (medium '" + f.medium_other +
            strf("'), both of priority %d, have a face in common at (%.6g, %.6g, %.6g) m: which of the media holds "
                 "behind it is left open",
                 f.priority, f.at.x, f.at.y, f.at.z));
  }
}

}  // namespace suite
