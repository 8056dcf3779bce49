// Ways of light from a node through smooth interfaces, as the search for them finds them (refracted/sight.h).
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

#include "surface/surface.h"

namespace suite {

// A smooth interface on a way.
struct RefractedEvent {
  Hit hit;
  double length = 0;  // m from the place before
  Dir out, in;        // back towards the node, on towards the light
  Dir out_local;      // `out` in the shading frame
  uint32_t material = kNone;
  const ScatterModel* model = nullptr;
  bool reflected = false;
};

// What ways lead to: a light at infinity, or a place on a lamp.
struct WayEnd {
  Dir direction;  // far; unit
  Vec3 place;     // else; m, ENU
  bool far = true;
  bool surface = false;  // the place is one of a surface
};

// Where a way starts.
struct WayStart {
  Vec3 place;
  const Hit* hit = nullptr;  // of a surface; null = in a medium
  Dir side = {};             // an opaque surface takes light only from the half space of this direction; 0 = all
  double time = 0;           // s
  uint32_t draw = 0;         // Ray::draw
};

struct RefractedWay {
  static constexpr int kMostEvents = 10;
  Vec3 origin;    // of the ray that leaves the node
  Dir direction;  // from the node
  int events = 0;
  Vec3 last;                                                // place of the last of them
  Dir to;                                                   // towards the light from there
  double length = std::numeric_limits<double>::infinity();  // m, to a lamp from there
  Hit lamp;                                                 // of a lamp's surface
  double spreading = 0;  // solid angle at the node over that at the light; over 1 m2 across the way at a lamp, 1/m2
  double trials = 1;     // the estimated reciprocal of the probability with which it was found
  bool doubtful = false;
  RefractedEvent at[kMostEvents];

  RefractedWay() = default;
  RefractedWay(const RefractedWay& o) { *this = o; }
  // Of the events those that there are: as a rule one of ten.
  RefractedWay& operator=(const RefractedWay& o) {
    origin = o.origin, direction = o.direction, events = o.events;
    last = o.last, to = o.to, length = o.length, lamp = o.lamp;
    spreading = o.spreading, trials = o.trials, doubtful = o.doubtful;
    if (this != &o) std::copy_n(o.at, o.events, at);
    return *this;
  }
  // A bit for each event that reflects.
  uint32_t mirrors() const {
    uint32_t bits = 0;
    for (int i = 0; i < events; ++i) bits |= uint32_t{at[i].reflected} << i;
    return bits;
  }
};

}  // namespace suite
