// Direct sun through a day on any place: what elements are cut by.
#pragma once
#include "heat/elements.h"
#include "motion/time_span.h"

namespace suite {

// The sun at a time: the beam of a clear sky on a plane that faces it. It does not ask the weather, so that the same
// elements are found for another.
struct SunMoment {
  double time = 0, direct = 0;  // s, W/m2
  Dir towards;                  // scene ENU
  bool operator==(const SunMoment& o) const {
    return time == o.time && direct == o.direct && towards.x == o.towards.x && towards.y == o.towards.y &&
           towards.z == o.towards.z;
  }
};

// Up to `most` times of the span (s) with the sun up, evenly. towards: to the sun, scene ENU.
// Source of the beam: A. B. Meinel, M. P. Meinel, Applied Solar Energy, 1976: 1353 W/m2 x 0.7^(air mass^0.678).
std::vector<SunMoment> sun_moments(TimeSpan span, const std::function<Dir(double t)>& towards, size_t most = 16);

// The beam at these moments on the front of a place where nothing hides the middle of the sun, W/m2. Keeps a reference
// to the tracer.
DaySun day_sun(const Tracer& tracer, std::vector<SunMoment> asked);

// What elements were made with; with it the same are made again, whatever the day.
struct HeatCut {
  size_t elements = 0;                   // as asked for
  bool by_sun = false;                   // else of about equal areas
  std::vector<SunMoment> sun;            // of these moments, none where it never rose
  std::vector<uint32_t> kept;            // of these elements, ascending, where some were left out
  std::vector<CellSplit> splits;         // what was cut; none: to be found with the sun
  std::vector<RestInterval> rests = {};  // of what moves, comes or goes; none: of all of the time
  bool operator==(const HeatCut&) const = default;
};

}  // namespace suite
