// When placements are there, and of what they are made then: by their schedules, and by tracks beyond whose ends they
// are absent. A group that is absent takes all that it places with it; that is for whoever walks down the hierarchy.
#pragma once
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace suite {

// What a placement with this track and this schedule (indices, kNone = none) is made of at a time: the material that
// its schedule names, kNone for its own. Nothing while it is not there.
std::optional<uint32_t> made_at(const Scene& scene, uint32_t track, uint32_t schedule, double t);

// All that a placement of this schedule is made of at some time or other, each once; kNone for its own.
std::vector<uint32_t> made_of(const Scene& scene, uint32_t schedule);

// Whether a placement is there in a span of time; hull: from when until when, only where there is any.
struct Presence {
  bool any = false, all = false;
  TimeSpan hull;
};
// material: there and made of this one only; nothing: of whatever. The hull may be longer than what it holds.
Presence presence(const Scene& scene, uint32_t track, uint32_t schedule, std::optional<uint32_t> material,
                  TimeSpan span);

}  // namespace suite
